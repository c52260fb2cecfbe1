#pragma once

/// The equality constraint Gx = 0 as SMALBE sees it: a few rows, known on every rank, that are orthonormal:
/// GGᵀ = I.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Types.hpp"

#include <span>

namespace epafi::qp {

class EqualityConstraint {
public:
  virtual ~EqualityConstraint() = default;
  /// Number of rows, the same on all ranks.
  [[nodiscard]] virtual int size() const = 0;
  /// Adds this rank's contribution to the product with x; `finishProduct` makes Gx of the sums over the
  /// ranks. Not collective.
  virtual void addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const = 0;
  /// gx = Gx from the sums over the ranks. Both have size() entries. Not collective.
  virtual void finishProduct(std::span<const AccurateSum> sums, std::span<double> gx) const {
    for (std::size_t k = 0; k < gx.size(); ++k)
      gx[k] = sums[k].value();
  }
  /// y += factor · Gᵀμ; μ is the same on all ranks. Not collective.
  virtual void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const = 0;
};

} // namespace epafi::qp
