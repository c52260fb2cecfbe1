#include "epafi/qp/EqualityConstraint.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>

namespace epafi::qp {

void ReplicatedEquality::finishProduct(std::span<const AccurateSum> sums, std::span<double> bx) const {
  for (std::size_t k = 0; k < bx.size(); ++k)
    bx[k] = sums[k].value();
}

double ReplicatedEquality::finishResidual(std::span<const AccurateSum> sums, std::span<double> r) const {
  finishProduct(sums, r);
  const std::span<const double> c = rightHandSide();
  for (std::size_t k = 0; k < c.size(); ++k)
    r[k] -= c[k];
  return std::sqrt(dot(r, r));
}

void ReplicatedEquality::product(const Vector& x, std::span<double> bx) const {
  sums_.assign(numEntries(), AccurateSum());
  addLocalProduct(x, sums_);
  sumOverRanks(*x.getMap()->getComm(), sums_);
  finishProduct(sums_, bx);
}

double ReplicatedEquality::dot(std::span<const double> a, std::span<const double> b) const {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += a[k] * b[k];
  return sum;
}

} // namespace epafi::qp
