#include "epafi/qp/SpectrumEstimate.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/qp/StartVector.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace epafi::qp {
namespace {

/// Ritz values below this times the largest are the kernel, which round-off has brought in.
constexpr double kernelShare = 1e-10;

/// Extreme eigenvalues of the Lanczos matrix, with the bounds |β s| for eigenvectors that end in s. An end that is accurate
/// already stays: what follows may be round-off.
void setRitzValues(std::vector<double> diagonal, std::vector<double> offDiagonal, double beta,
                   double accuracy, SpectrumEstimate& estimate) {
  const int n = static_cast<int>(diagonal.size());
  const auto size = static_cast<std::size_t>(n);
  std::vector<double> vectors(size * size), work(std::max<std::size_t>(1, 2 * size));
  offDiagonal.resize(size);
  int info = 0;
  Teuchos::LAPACK<int, double>().STEQR('I', n, diagonal.data(), offDiagonal.data(), vectors.data(), n,
                                       work.data(), &info);
  if (info != 0)
    throw Error("the eigenvalues of the Lanczos matrix could not be computed");
  if (!estimate.largestIsAccurate(accuracy)) {
    estimate.largest = diagonal.back();
    estimate.largestError = beta * std::abs(vectors.back());
  }
  if (estimate.smallestIsAccurate(accuracy))
    return;
  std::size_t least = 0;
  while (least + 1 < size && diagonal[least] <= kernelShare * diagonal.back())
    ++least;
  estimate.smallest = diagonal[least];
  estimate.smallestError = beta * std::abs(vectors[least * size + size - 1]);
}

/// ‖r‖ in the inner product of M, with z = Mr.
double preconditionedNorm(const Operator* m, const Vector& r, Vector& z) {
  if (m != nullptr)
    m->apply(r, z);
  else
    z.assign(r);
  const double squared = accurateDot(r, z);
  if (!std::isfinite(squared))
    throw Error("an operator returned a value that is not finite while its spectrum was estimated; check its "
                "entries");
  if (squared < 0)
    throw Error("the preconditioner is not positive definite: rᵀMr = " + std::to_string(squared) +
                " for a residual r; check that it is symmetric positive definite");
  return std::sqrt(squared);
}

} // namespace

SpectrumEstimate estimateSpectrum(const Operator& a, const RCP<const Operator>& m,
                                  const SpectrumEstimateParameters& parameters) {
  Vector v(a.getDomainMap()), previous(a.getDomainMap()), w(a.getDomainMap()), z(a.getDomainMap());
  SpectrumEstimate estimate;
  fillFromIndices(z);
  a.apply(z, w);
  estimate.multiplications = 1;
  double beta = preconditionedNorm(m.get(), w, z);
  const double start = beta;
  std::vector<double> diagonal, offDiagonal;
  int nextCheck = 12; // before, a start near one eigenvector would pass for the whole spectrum
  while (beta > 1e-13 * start) {
    previous.assign(v);
    v.update(1.0 / beta, w, 0.0);
    z.scale(1.0 / beta); // Mv
    a.apply(z, w);       // w = A M v_k − β_{k−1} v_{k−1} − α_k v_k
    ++estimate.multiplications;
    if (!diagonal.empty()) {
      offDiagonal.push_back(beta);
      w.update(-beta, previous, 1.0);
    }
    diagonal.push_back(accurateDot(w, z));
    w.update(-diagonal.back(), v, 1.0);
    beta = preconditionedNorm(m.get(), w, z);
    const bool isLast = estimate.multiplications >= parameters.maxIterations || beta <= 1e-13 * start;
    if (!isLast && estimate.multiplications < nextCheck)
      continue;
    nextCheck = estimate.multiplications + 1 + estimate.multiplications / 8;
    setRitzValues(diagonal, offDiagonal, beta, parameters.accuracy, estimate);
    if (isLast ||
        (estimate.smallestIsAccurate(parameters.accuracy) && estimate.largestIsAccurate(parameters.accuracy)))
      break;
  }
  return estimate;
}

} // namespace epafi::qp
