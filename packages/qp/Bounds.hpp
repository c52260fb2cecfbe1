#pragma once

/// The box l ≤ x ≤ u, and what MPRGP asks of it: the projection, the longest feasible step, and the split of
/// a gradient into its free and its chopped part.
///
/// For the gradient g at a feasible x (Dostál, *Optimal Quadratic Programming Algorithms*, 2009, ch. 5):
///   free gradient          φ_i = g_i where l_i < x_i < u_i, else 0
///   chopped gradient       β_i = min(g_i, 0) at a lower bound, max(g_i, 0) at an upper one, 0 where l_i =
///   u_i, else 0 reduced free gradient  φ̃_i = φ_i, cut so that x − ᾱφ̃ stays feasible projected gradient g^P =
///   φ + β; it vanishes exactly at a solution

#include "epafi/base/Types.hpp"
#include "epafi/qp/LocalData.hpp"

#include <algorithm>
#include <limits>

namespace epafi::qp {

class Bounds {
public:
  /// One entry's bounds.
  struct Interval {
    double lower, upper;
    [[nodiscard]] bool isFree(double x) const { return lower < x && x < upper; }
    [[nodiscard]] double project(double x) const { return std::min(std::max(x, lower), upper); }
    [[nodiscard]] double freeGradient(double x, double g) const { return isFree(x) ? g : 0.0; }
    [[nodiscard]] double choppedGradient(double x, double g) const {
      if (isFree(x) || !(lower < upper))
        return 0.0;
      return x <= lower ? std::min(g, 0.0) : std::max(g, 0.0);
    }
    /// φ̃ for the step ᾱ = `step`, at a free entry with gradient g.
    [[nodiscard]] double reducedFreeGradient(double x, double g, double step) const {
      return g > 0 ? std::min((x - lower) / step, g) : std::max((x - upper) / step, g);
    }
    /// Largest α with x − αp in the interval.
    [[nodiscard]] double maxFeasibleStep(double x, double p) const {
      if (p > 0)
        return (x - lower) / p;
      if (p < 0)
        return (x - upper) / p;
      return std::numeric_limits<double>::infinity();
    }
  };

  /// \param lower, upper  vectors on the unknowns' map, −∞ and +∞ for "no bound"; null where no entry has
  ///        one. Shared, never changed.
  explicit Bounds(RCP<const Vector> lower, RCP<const Vector> upper = Teuchos::null);

  /// This rank's bounds by local index; cheap to make, valid while the bounds live.
  class Local {
  public:
    explicit Local(const Bounds& bounds);
    [[nodiscard]] Interval operator[](std::size_t i) const {
      return {lower_ ? lower_[i] : -std::numeric_limits<double>::infinity(),
              upper_ ? upper_[i] : std::numeric_limits<double>::infinity()};
    }

  private:
    const double* lower_ = nullptr;
    const double* upper_ = nullptr;
  };
  [[nodiscard]] Local local() const { return Local(*this); }

  /// x becomes the nearest feasible point. Not collective.
  void project(Vector& x) const;

  /// Throws InputError, on all ranks alike, if l_i > u_i or a bound is NaN somewhere. Collective.
  void check(const Comm& comm) const;

private:
  RCP<const Vector> lower_, upper_;
};

} // namespace epafi::qp
