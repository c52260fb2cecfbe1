#pragma once

/// This rank's entries of a Tpetra vector as a span, for the fused loops of the solvers. A span is valid
/// while its vector lives; hold it only for the length of a loop. Not collective.

#include "epafi/base/Types.hpp"

#include <Tpetra_Vector.hpp>

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

/// y += factor · x; unlike Vector::update it allocates nothing.
inline void addScaled(double factor, const Vector& x, Vector& y) {
  const auto in = localData(x);
  const auto out = localDataNonConst(y);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] += factor * in[i];
}

} // namespace epafi::qp
