#include "epafi/qp/operators/SpectrumEstimate.hpp"

#include "epafi/qp/operators/Lanczos.hpp"
#include "epafi/qp/operators/StartVector.hpp"

#include <Tpetra_Operator.hpp>

namespace epafi::qp {
namespace {

/// Ritz values below this times the largest are the kernel, which round-off has brought in.
constexpr double kernelShare = 1e-10;

/// An end that is accurate already stays: what follows may be round-off.
void setRitzValues(const std::vector<Lanczos::RitzValue>& ritz, double accuracy, SpectrumEstimate& estimate) {
  if (!estimate.largestIsAccurate(accuracy)) {
    estimate.largest = ritz.back().value;
    estimate.largestError = ritz.back().error;
  }
  if (estimate.smallestIsAccurate(accuracy))
    return;
  std::size_t least = 0;
  while (least + 1 < ritz.size() && ritz[least].value <= kernelShare * ritz.back().value)
    ++least;
  estimate.smallest = ritz[least].value;
  estimate.smallestError = ritz[least].error;
}

/// Ax for a pseudo-random x.
Vector startInRange(const Operator& a) {
  Vector x(a.getDomainMap()), ax(a.getRangeMap());
  fillFromIndices(x);
  a.apply(x, ax);
  return ax;
}

} // namespace

SpectrumEstimate estimateSpectrum(const Operator& a, const RCP<const Operator>& m,
                                  const SpectrumEstimateParameters& parameters) {
  SpectrumEstimate estimate;
  Lanczos lanczos(a, m.get(), startInRange(a));
  estimate.multiplications = 1;
  int nextCheck = 12; // before, a start near one eigenvector would pass for the whole spectrum
  while (!lanczos.isExhausted()) {
    lanczos.step();
    ++estimate.multiplications;
    const bool isLast = estimate.multiplications >= parameters.maxIterations || lanczos.isExhausted();
    if (!isLast && estimate.multiplications < nextCheck)
      continue;
    nextCheck = estimate.multiplications + 1 + estimate.multiplications / 8;
    setRitzValues(lanczos.ritzValues(), parameters.accuracy, estimate);
    if (isLast ||
        (estimate.smallestIsAccurate(parameters.accuracy) && estimate.largestIsAccurate(parameters.accuracy)))
      break;
  }
  return estimate;
}

} // namespace epafi::qp
