#include "epafi/qp/operators/Lanczos.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace epafi::qp {
namespace {

void requireFinite(double value) {
  if (!std::isfinite(value))
    throw Error(
        "the operator returned a value that is not finite while its norm was estimated; check its entries");
}

} // namespace

Lanczos::Lanczos(const Operator& a, const Operator* m, const Vector& start)
    : a_(a), m_(m), v_(start.getMap()), previous_(start.getMap()), w_(start, Teuchos::Copy) {
  if (m_ != nullptr)
    z_ = Vector(start.getMap());
  measure();
}

/// ‖w‖ in the inner product of M, with z = Mw.
void Lanczos::measure() {
  if (m_ == nullptr) {
    beta_ = accurateNorm(w_);
    requireFinite(beta_);
    return;
  }
  m_->apply(w_, z_);
  const double squared = accurateDot(w_, z_);
  requireFinite(squared);
  if (squared < 0)
    throw Error("the preconditioner is not positive definite: rᵀMr = " + std::to_string(squared) +
                " for a residual r; check that it is symmetric positive definite");
  beta_ = std::sqrt(squared);
}

void Lanczos::step() {
  previous_.assign(v_);
  v_.update(1.0 / beta_, w_, 0.0);
  if (m_ != nullptr)
    z_.scale(1.0 / beta_);        // Mv
  a_.apply(preconditioned(), w_); // w = A M v_k − β_{k−1} v_{k−1} − α_k v_k
  if (!diagonal_.empty()) {
    offDiagonal_.push_back(beta_);
    w_.update(-beta_, previous_, 1.0);
  }
  diagonal_.push_back(accurateDot(w_, preconditioned()));
  requireFinite(diagonal_.back());
  w_.update(-diagonal_.back(), v_, 1.0);
  measure();
  largest_ = std::max({largest_, diagonal_.back(), beta_});
}

std::vector<Lanczos::RitzValue> Lanczos::ritzValues() const {
  std::vector<double> values = diagonal_, offDiagonal = offDiagonal_;
  const std::size_t size = values.size();
  const int n = static_cast<int>(size);
  std::vector<double> vectors(size * size), work(2 * size);
  offDiagonal.resize(size);
  int info = 0;
  Teuchos::LAPACK<int, double>().STEQR('I', n, values.data(), offDiagonal.data(), vectors.data(), n,
                                       work.data(), &info);
  if (info != 0)
    throw Error("the eigenvalues of the Lanczos matrix could not be computed");
  std::vector<RitzValue> result;
  for (std::size_t k = 0; k < size; ++k) // the residual of a Ritz vector whose coefficients end in s is |β s|
    result.push_back({values[k], beta_ * std::abs(vectors[k * size + size - 1])});
  return result;
}

} // namespace epafi::qp
