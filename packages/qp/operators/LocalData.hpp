#pragma once

/// This rank's entries of a Tpetra vector as a span, for the fused loops of the solvers. A span is valid
/// while its vector lives; hold it only for the length of a loop. Not collective.

#include "epafi/base/Types.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace epafi::qp {

inline std::span<const double> localData(const Vector& x) {
  const auto view = x.getLocalViewHost(Tpetra::Access::ReadOnly);
  return {view.data(), view.extent(0)};
}

inline std::span<double> localDataNonConst(Vector& x) {
  const auto view = x.getLocalViewHost(Tpetra::Access::ReadWrite);
  return {view.data(), view.extent(0)};
}

/// The same of one column of a multivector.
inline std::span<const double> localColumn(const MultiVector& x, std::size_t column) {
  if (!x.isConstantStride())
    return localData(*x.getVector(column));
  const auto view = x.getLocalViewHost(Tpetra::Access::ReadOnly);
  return {view.data() + column * static_cast<std::size_t>(view.stride(1)), view.extent(0)};
}

inline std::span<double> localColumnNonConst(MultiVector& x, std::size_t column) {
  if (!x.isConstantStride())
    return localDataNonConst(*x.getVectorNonConst(column));
  const auto view = x.getLocalViewHost(Tpetra::Access::ReadWrite);
  return {view.data() + column * static_cast<std::size_t>(view.stride(1)), view.extent(0)};
}

/// y += factor · x; unlike Vector::update it allocates nothing.
inline void addScaled(double factor, const Vector& x, Vector& y) {
  const auto in = localData(x);
  const auto out = localDataNonConst(y);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] += factor * in[i];
}

/// to = from; unlike Vector::assign it allocates nothing.
inline void copy(const Vector& from, Vector& to) {
  const auto in = localData(from);
  std::copy(in.begin(), in.end(), localDataNonConst(to).begin());
}

/// p = z − conjugation · p; with 0 the old p is not read.
inline void setConjugate(const Vector& z, double conjugation, Vector& p) {
  const auto from = localData(z);
  const auto direction = localDataNonConst(p);
  for (std::size_t i = 0; i < direction.size(); ++i)
    direction[i] = from[i] - (conjugation != 0 ? conjugation * direction[i] : 0.0);
}

} // namespace epafi::qp
