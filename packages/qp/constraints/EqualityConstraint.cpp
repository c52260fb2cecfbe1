#include "epafi/qp/constraints/EqualityConstraint.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::qp {
namespace {

/// A⁺ of a symmetric positive semidefinite A, k × k, both triangles stored.
std::vector<double> pseudoInverse(std::vector<double> a, int k) {
  constexpr double roundOff = 1e-12; // of the largest eigenvalue
  const std::size_t size = k;
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

class DenseFaceInverse final : public FaceInverse {
public:
  DenseFaceInverse(const ReplicatedEquality& equality, const RCP<const Map>& map)
      : equality_(equality), size_(equality.numEntries()), column_(map) {}

  void setFace(const Face& face) override {
    std::vector<AccurateSum> sums(size_ * size_);
    std::vector<double> unit(size_, 0.0), gram(size_ * size_);
    for (std::size_t j = 0; j < size_; ++j) {
      unit[j] = 1;
      column_.putScalar(0.0);
      equality_.addTransposedProduct(unit, 1.0, column_);
      unit[j] = 0;
      face.restrict(column_, column_);
      equality_.addLocalProduct(column_, std::span(sums).subspan(j * size_, size_));
    }
    sumOverRanks(*column_.getMap()->getComm(), sums);
    for (std::size_t j = 0; j < size_; ++j)
      ReplicatedEquality::finishProduct(std::span(sums).subspan(j * size_, size_),
                                        std::span(gram).subspan(j * size_, size_));
    inverse_ = pseudoInverse(std::move(gram), static_cast<int>(size_));
  }

  void apply(std::span<const double> b, std::span<double> mu) const override {
    std::fill(mu.begin(), mu.end(), 0.0);
    for (std::size_t j = 0; j < size_; ++j)
      for (std::size_t i = 0; i < size_; ++i)
        mu[i] += inverse_[j * size_ + i] * b[j];
  }

private:
  const ReplicatedEquality& equality_;
  std::size_t size_;
  std::vector<double> inverse_; ///< k × k
  Vector column_;               ///< work
};

} // namespace

std::unique_ptr<FaceInverse> ReplicatedEquality::faceInverse(const RCP<const Map>& map) const {
  return std::make_unique<DenseFaceInverse>(*this, map);
}

void EqualityConstraint::weigh(std::span<const double> r, std::span<double> mu) const {
  std::copy(r.begin(), r.end(), mu.begin());
}

double EqualityConstraint::normOf(std::span<const double> r) const {
  std::vector<double> mu(r.size());
  weigh(r, mu);
  return std::sqrt(std::max(dot(mu, r), 0.0)); // so NaN stays
}

void ReplicatedEquality::finishProduct(std::span<const AccurateSum> sums, std::span<double> bx) {
  for (std::size_t k = 0; k < bx.size(); ++k)
    bx[k] = sums[k].value();
}

double ReplicatedEquality::finishResidual(std::span<const AccurateSum> sums, std::span<double> r,
                                          std::span<double> weighed) const {
  finishProduct(sums, r);
  const std::span<const double> c = rightHandSide();
  for (std::size_t k = 0; k < c.size(); ++k)
    r[k] -= c[k];
  weigh(r, weighed);
  return std::sqrt(std::max(dot(weighed, r), 0.0)); // of round-off; so NaN stays
}

void ReplicatedEquality::product(const Vector& x, std::span<double> bx) const {
  sums_.assign(numEntries(), AccurateSum());
  addLocalProduct(x, sums_);
  sumOverRanks(*x.getMap()->getComm(), sums_);
  finishProduct(sums_, bx);
}

double ReplicatedEquality::dot(std::span<const double> mu, std::span<const double> r) const {
  double sum = 0;
  for (std::size_t k = 0; k < mu.size(); ++k)
    sum += mu[k] * r[k];
  return sum;
}

} // namespace epafi::qp
