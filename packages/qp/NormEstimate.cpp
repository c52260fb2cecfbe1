#include "epafi/qp/NormEstimate.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/qp/StartVector.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Operator.hpp>

#include <cmath>
#include <vector>

namespace epafi::qp {
namespace {

void requireFinite(double value) {
  if (!std::isfinite(value))
    throw Error(
        "the operator returned a value that is not finite while its norm was estimated; check its entries");
}

struct RitzPair {
  double value = 0;         ///< largest eigenvalue of the tridiagonal matrix
  double lastComponent = 0; ///< last entry of its unit eigenvector
};

RitzPair largestRitzPair(std::vector<double> diagonal, std::vector<double> offDiagonal) {
  const int n = static_cast<int>(diagonal.size());
  std::vector<double> vectors(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  std::vector<double> work(static_cast<std::size_t>(std::max(1, 2 * n - 2)));
  offDiagonal.resize(static_cast<std::size_t>(n));
  int info = 0;
  Teuchos::LAPACK<int, double>().STEQR('I', n, diagonal.data(), offDiagonal.data(), vectors.data(), n,
                                       work.data(), &info);
  if (info != 0)
    throw Error("the eigenvalues of the Lanczos matrix could not be computed");
  return {diagonal.back(), vectors.back()};
}

NormEstimate lanczos(const Operator& a, const NormEstimateParameters& parameters) {
  Vector v(a.getDomainMap()), previous(a.getDomainMap()), w(a.getDomainMap());
  NormEstimate estimate;
  fillFromIndices(v);
  const double startNorm = accurateNorm(v);
  if (startNorm == 0)
    return estimate;
  v.scale(1.0 / startNorm);

  std::vector<double> diagonal, offDiagonal;
  double beta = 0;
  const auto dimension = static_cast<int>(std::min<Tpetra::global_size_t>(v.getGlobalLength(), 100000));
  while (estimate.multiplications < std::min(parameters.maxIterations, dimension)) {
    a.apply(v, w); // w = A v_k − β_{k−1} v_{k−1}
    ++estimate.multiplications;
    if (beta > 0)
      w.update(-beta, previous, 1.0);
    const double alpha = accurateDot(w, v);
    requireFinite(alpha);
    w.update(-alpha, v, 1.0);
    beta = accurateNorm(w);
    diagonal.push_back(alpha);

    const RitzPair ritz = largestRitzPair(diagonal, offDiagonal);
    const double residual = beta * std::abs(ritz.lastComponent); // ‖A y − θ y‖ of the Ritz vector y
    estimate.lowerBound = std::max(ritz.value, 0.0);
    estimate.norm = std::max(estimate.lowerBound + residual, parameters.safety * estimate.lowerBound);
    if (residual <= parameters.accuracy * estimate.lowerBound || beta <= 1e-14 * estimate.norm)
      break;
    offDiagonal.push_back(beta);
    previous.assign(v);
    v.update(1.0 / beta, w, 0.0);
  }
  return estimate;
}

NormEstimate power(const Operator& a, const NormEstimateParameters& parameters) {
  Vector v(a.getDomainMap()), w(a.getDomainMap());
  NormEstimate estimate;
  fillFromIndices(v);
  double norm = accurateNorm(v);
  while (norm > 0 && estimate.multiplications < parameters.maxIterations) {
    v.scale(1.0 / norm);
    a.apply(v, w);
    ++estimate.multiplications;
    const double quotient = accurateDot(w, v);
    requireFinite(quotient);
    const bool settled =
        std::abs(quotient - estimate.lowerBound) <= 0.1 * parameters.accuracy * std::abs(quotient);
    estimate.lowerBound = std::max(quotient, 0.0);
    if (settled)
      break;
    norm = accurateNorm(w);
    v.assign(w);
  }
  estimate.norm = parameters.safety * estimate.lowerBound;
  return estimate;
}

} // namespace

Teuchos::ParameterList NormEstimateParameters::validParameters() {
  const NormEstimateParameters defaults;
  Teuchos::ParameterList list("Norm Estimate");
  addChoice(list, "Method", "lanczos", "How the largest eigenvalue of the operator is estimated.",
            {"lanczos", "power"});
  addInteger(list, "Maximum Iterations", defaults.maxIterations, "Products with the operator at most.", 1);
  addReal(list, "Accuracy", defaults.accuracy, "Relative distance of the bound at which the estimate stops.",
          0.0, 1.0, true);
  addReal(
      list, "Safety", defaults.safety,
      "The estimate is at least this factor times the largest Rayleigh quotient seen, which approaches the "
      "norm from below.",
      1.0, 100.0);
  return list;
}

NormEstimateParameters NormEstimateParameters::from(const Teuchos::ParameterList& list) {
  NormEstimateParameters parameters;
  parameters.method = list.get<std::string>("Method") == "power" ? Method::power : Method::lanczos;
  parameters.maxIterations = list.get<int>("Maximum Iterations");
  parameters.accuracy = list.get<double>("Accuracy");
  parameters.safety = list.get<double>("Safety");
  return parameters;
}

NormEstimate estimateNorm(const Operator& a, const NormEstimateParameters& parameters) {
  return parameters.method == NormEstimateParameters::Method::lanczos ? lanczos(a, parameters)
                                                                      : power(a, parameters);
}

} // namespace epafi::qp
