#pragma once

/// The equality constraint Gx = 0 as SMALBE sees it: a few rows, known on every rank, that are orthonormal:
/// GGᵀ = I.

#include "epafi/base/Types.hpp"

#include <span>

namespace epafi::qp {

class EqualityConstraint {
public:
  virtual ~EqualityConstraint() = default;
  /// Number of rows, the same on all ranks.
  [[nodiscard]] virtual int size() const = 0;
  /// Adds this rank's contribution to Gx: the sum over the ranks is Gx. Not collective.
  virtual void addLocalProduct(const Vector& x, std::span<double> gx) const = 0;
  /// y += factor · Gᵀμ; μ is the same on all ranks. Not collective.
  virtual void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const = 0;
};

} // namespace epafi::qp
