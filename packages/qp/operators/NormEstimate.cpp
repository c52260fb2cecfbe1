#include "epafi/qp/operators/NormEstimate.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/qp/operators/Lanczos.hpp"
#include "epafi/qp/operators/StartVector.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>

namespace epafi::qp {

Teuchos::ParameterList NormEstimateParameters::validParameters() {
  const NormEstimateParameters defaults;
  Teuchos::ParameterList list("Norm Estimate");
  addInteger(list, "Maximum Iterations", defaults.maxIterations, "Products with the operator at most.", 1);
  addReal(list, "Accuracy", defaults.accuracy, "Relative distance of the bound at which the estimate stops.",
          0.0, 1.0, true);
  addReal(list, "Safety", defaults.safety,
          "The estimate is at least this factor times the largest Rayleigh quotient seen, which approaches "
          "the norm from below.",
          1.0, 100.0);
  return list;
}

NormEstimateParameters NormEstimateParameters::from(const Teuchos::ParameterList& list) {
  NormEstimateParameters parameters;
  parameters.maxIterations = list.get<int>("Maximum Iterations");
  parameters.accuracy = list.get<double>("Accuracy");
  parameters.safety = list.get<double>("Safety");
  return parameters;
}

NormEstimate estimateNorm(const Operator& a, const NormEstimateParameters& parameters) {
  Vector start(a.getDomainMap());
  fillFromIndices(start);
  Lanczos lanczos(a, nullptr, start);
  NormEstimate estimate;
  const auto dimension = static_cast<int>(std::min<Tpetra::global_size_t>(start.getGlobalLength(), 100000));
  while (!lanczos.isExhausted() && estimate.multiplications < std::min(parameters.maxIterations, dimension)) {
    lanczos.step();
    ++estimate.multiplications;
    const Lanczos::RitzValue largest = lanczos.ritzValues().back();
    estimate.lowerBound = std::max(largest.value, 0.0);
    estimate.norm = std::max(estimate.lowerBound + largest.error, parameters.safety * estimate.lowerBound);
    if (largest.error <= parameters.accuracy * estimate.lowerBound)
      break;
  }
  return estimate;
}

} // namespace epafi::qp
