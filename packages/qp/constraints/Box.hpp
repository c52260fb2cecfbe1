#pragma once

/// The box l ≤ x ≤ u: lower, upper, two-sided or no bounds, mixed entry by entry. l_i = u_i fixes an entry.

#include "epafi/qp/constraints/ConvexSet.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace epafi::qp {

class Box final : public ConvexSet {
public:
  /// One entry's bounds.
  struct Interval {
    double lower, upper;
    /// Whether no bound holds the feasible x.
    [[nodiscard]] bool isFree(double x) const { return lower < x && x < upper; }
    /// The nearest number within the bounds.
    [[nodiscard]] double project(double x) const { return std::min(std::max(x, lower), upper); }
    /// φ: g at a free entry, else 0.
    [[nodiscard]] double freeGradient(double x, double g) const { return isFree(x) ? g : 0.0; }
    /// min(g, 0) at a lower bound, max(g, 0) at an upper one, 0 for a fixed entry.
    [[nodiscard]] double choppedGradient(double x, double g) const {
      if (isFree(x) || !(lower < upper))
        return 0.0;
      return x <= lower ? std::min(g, 0.0) : std::max(g, 0.0);
    }
    /// The same, 0 if it is no larger than `negligible`.
    [[nodiscard]] double choppedGradient(double x, double g, double negligible) const {
      const double chopped = choppedGradient(x, g);
      return std::abs(chopped) > negligible ? chopped : 0.0;
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
  /// one. Shared, never changed.
  explicit Box(RCP<const Vector> lower = Teuchos::null, RCP<const Vector> upper = Teuchos::null);

  /// An interval around 0, or around what a shift made of it, whose half width grows with another entry.
  struct Growth {
    LocalOrdinal entry = 0, leader = 0; ///< of this rank
    double slope = 0;                   ///< of the half width over the leader, > 0
  };
  /// \param growth  of entries with bounds on both sides
  Box(RCP<const Vector> lower, RCP<const Vector> upper, std::vector<Growth> growth);

  /// This rank's bounds by local index; cheap to make, valid while the box lives.
  class Local {
  public:
    explicit Local(const Box& box); ///< keeps no more than addresses
    /// Bounds of the entry with the local index i.
    [[nodiscard]] Interval operator[](std::size_t i) const {
      return {lower_ ? lower_[i] : -std::numeric_limits<double>::infinity(),
              upper_ ? upper_[i] : std::numeric_limits<double>::infinity()};
    }

  private:
    const double* lower_ = nullptr;
    const double* upper_ = nullptr;
  };
  [[nodiscard]] Local local() const { return Local(*this); } ///< this rank's bounds
  [[nodiscard]] Box shifted(const Vector& x) const;          ///< what `shiftedBy` returns
  [[nodiscard]] Box cone(const RCP<const Map>& map) const;   ///< what `recessionCone` returns

  [[nodiscard]] std::string emptiness(const Map& map) const override;
  void project(Vector& x) const override;
  void move(double length, const Vector& p, Vector& x) const override;
  [[nodiscard]] double maxFeasibleStep(const Vector& x, const Vector& p) const override;
  [[nodiscard]] GradientSums measure(const Vector& x, const Vector& g, const Vector& image,
                                     double step) const override;
  void subtractFromFreeGradient(const Vector& x, const Vector& g, double factor, Vector& y) const override;
  void choppedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const override;
  void projectedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const override;
  void restrictToFree(const Vector& x, Vector& z) const override;
  void restrictToReleased(const Vector& x, const Vector& g, double negligible, Vector& z) const override;
  void freeIndicator(const Vector& x, Vector& y) const override;
  void fixedIndicator(Vector& y) const override;
  void distanceToBoundary(const Vector& x, double atMost, Vector& y) const override;
  void activate(const Vector& active, Vector& x) const override;
  [[nodiscard]] double complementarity(const Vector& x, const Vector& g, double scale) const override;
  [[nodiscard]] double longestMultiplierStep(const Vector& x, const Vector& g,
                                             const Vector& s) const override;
  [[nodiscard]] RCP<const ConvexSet> shiftedBy(const Vector& x) const override;
  /// 0 takes the place of every finite bound.
  [[nodiscard]] RCP<const ConvexSet> recessionCone(const RCP<const Map>& map) const override;
  void followBoundary(const Vector& x, const Vector& g, double least, const Face* from,
                      Face& face) const override;
  void releases(const Vector& x, const Vector& g, const Vector& s, double least, Vector& y) const override;

private:
  RCP<const Vector> lower_, upper_;
  std::vector<Growth> growth_;
};

} // namespace epafi::qp
