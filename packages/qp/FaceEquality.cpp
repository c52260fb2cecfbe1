#include "epafi/qp/FaceEquality.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <utility>

namespace epafi::qp {
namespace {

/// A⁺ of a symmetric positive semidefinite A, k × k, both triangles stored.
std::vector<double> pseudoInverse(std::vector<double> a, int k) {
  constexpr double roundOff = 1e-12; // of the largest eigenvalue
  const auto size = static_cast<std::size_t>(k);
  std::vector<double> values(size), work(3 * size), result(size * size, 0.0);
  int info = 0;
  Teuchos::LAPACK<int, double>().SYEV('V', 'L', k, a.data(), k, values.data(), work.data(),
                                      static_cast<int>(work.size()), &info);
  if (info != 0)
    throw Error("the equality constraints on a face could not be decomposed");
  for (std::size_t v = 0; v < size; ++v) {
    if (!(values[v] > roundOff * values.back()))
      continue;
    const double* vector = &a[v * size];
    for (std::size_t j = 0; j < size; ++j)
      for (std::size_t i = 0; i < size; ++i)
        result[j * size + i] += vector[i] * vector[j] / values[v];
  }
  return result;
}

} // namespace

FaceEquality::FaceEquality(RCP<const ReplicatedEquality> equality, const RCP<const Map>& map)
    : equality_(std::move(equality)), numRows_(equality_.is_null() ? 0 : equality_->size()), column_(map),
      product_(static_cast<std::size_t>(numRows_)), multiplier_(product_.size()) {}

void FaceEquality::setFace(const Vector& face) {
  face_ = &face;
  if (numRows_ == 0)
    return;
  const auto k = static_cast<std::size_t>(numRows_);
  std::vector<AccurateSum> sums(k * k);
  std::vector<double> unit(k, 0.0), gram(k * k);
  for (std::size_t j = 0; j < k; ++j) {
    unit[j] = 1;
    column_.putScalar(0.0);
    addTransposed(unit, 1.0, column_);
    unit[j] = 0;
    equality_->addLocalProduct(column_, std::span(sums).subspan(j * k, k));
  }
  sumOverRanks(*face.getMap()->getComm(), sums);
  for (std::size_t j = 0; j < k; ++j)
    equality_->finishProduct(std::span(sums).subspan(j * k, k), std::span(gram).subspan(j * k, k));
  inverse_ = pseudoInverse(std::move(gram), numRows_);
}

void FaceEquality::project(Vector& x) {
  addTransposed(fit(x), -1.0, x);
}

std::span<const double> FaceEquality::fit(Vector& x) {
  addTransposed(multiplier_, 0.0, x); // 0 off the face
  if (numRows_ > 0)
    equality_->product(x, product_);
  multiplierOf(product_, multiplier_);
  return multiplier_;
}

void FaceEquality::addLocalSums(const Vector& x, std::span<AccurateSum> sums) const {
  if (numRows_ > 0)
    equality_->addLocalProduct(x, sums);
}

void FaceEquality::finish(std::span<const AccurateSum> sums, std::span<double> bx) const {
  if (numRows_ > 0)
    equality_->finishProduct(sums, bx);
}

void FaceEquality::multiplierOf(std::span<const double> b, std::span<double> mu) const {
  std::fill(mu.begin(), mu.end(), 0.0);
  for (std::size_t j = 0; j < b.size(); ++j)
    for (std::size_t i = 0; i < b.size(); ++i)
      mu[i] += inverse_[j * b.size() + i] * b[j];
}

void FaceEquality::addTransposed(std::span<const double> mu, double factor, Vector& y) const {
  addWholeTransposed(mu, factor, y);
  const auto face = localData(*face_);
  const auto values = localDataNonConst(y);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] *= face[i];
}

void FaceEquality::addWholeTransposed(std::span<const double> mu, double factor, Vector& y) const {
  if (numRows_ > 0)
    equality_->addTransposedProduct(mu, factor, y);
}

void FaceEquality::residual(const Vector& x, std::span<double> r) const {
  if (numRows_ == 0)
    return;
  equality_->product(x, r);
  const auto c = equality_->rightHandSide();
  for (std::size_t i = 0; i < c.size(); ++i)
    r[i] -= c[i];
}

} // namespace epafi::qp
