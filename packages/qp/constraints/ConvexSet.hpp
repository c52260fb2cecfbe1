#pragma once

/// The feasible set Ω of a problem, and all that the methods ask of it. Their loops know no more than this.
/// `Box` is the set of bounds; in `Discs` pairs of entries have a bound on their length.
///
/// At a feasible x with the gradient g (Dostál, *Optimal Quadratic Programming Algorithms*, 2009, ch. 5; for
/// other sets Dostál, Kozubek, *Math. Program.* 135 (2012)):
///   free gradient φ what the iteration may follow without meeting the boundary; 0 on the active set
///   chopped gradient β         what leads from the boundary into the set
///   reduced free gradient φ̃    φ, cut so that x − ᾱφ̃ stays feasible
///   projected gradient         g^P = φ + β; it vanishes exactly at a solution
///
/// Unless said otherwise a function works on this rank's entries alone and is not collective. Vectors are on
/// the map of the unknowns; x is feasible where a gradient is split.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Types.hpp"
#include "epafi/qp/constraints/Face.hpp"

#include <string>

namespace epafi::qp {

/// What a step of MPRGP measures of the split gradient, one pass for all; this rank's shares, to be summed.
struct GradientSums {
  AccurateSum freeSquared;      ///< φᵀφ
  AccurateSum choppedSquared;   ///< βᵀβ
  AccurateSum reducedTimesFree; ///< φ̃ᵀφ
  AccurateSum freeTimesImage;   ///< φᵀw
  AccurateSum solutionSquared;  ///< xᵀx
  long long active = 0;         ///< entries on the boundary
};

class ConvexSet {
public:
  virtual ~ConvexSet() = default;

  /// Says why the set is empty, with the entry that shows it; an empty text if it is not.
  /// \throws InputError, on all ranks alike, if its data are not numbers or do not fit `map`.
  /// Collective.
  [[nodiscard]] virtual std::string emptiness(const Map& map) const = 0;

  /// x becomes the nearest feasible point.
  virtual void project(Vector& x) const = 0;
  /// x = P(x − αp).
  virtual void move(double length, const Vector& p, Vector& x) const = 0;
  /// Largest α ≥ 0 with x − αp feasible; infinity if there is none.
  [[nodiscard]] virtual double maxFeasibleStep(const Vector& x, const Vector& p) const = 0;
  /// \param image  w, any vector
  /// \param step   ᾱ of the reduced free gradient
  /// Streams x, g, w and the set's data once.
  [[nodiscard]] virtual GradientSums measure(const Vector& x, const Vector& g, const Vector& image,
                                             double step) const = 0;
  /// y = φ − factor · y; with factor 0 the old y is not read.
  virtual void subtractFromFreeGradient(const Vector& x, const Vector& g, double factor, Vector& y) const = 0;
  /// y = β, without what is no larger than `negligible`: a multiplier that is zero but for round-off releases
  /// nothing.
  virtual void choppedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const = 0;
  /// y = g^P, likewise.
  virtual void projectedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const = 0;
  /// z becomes 0 on the active set.
  virtual void restrictToFree(const Vector& x, Vector& z) const = 0;
  /// As restrictToFree, but z stays where β is not negligible and x − αz enters the set for small α > 0.
  virtual void restrictToReleased(const Vector& x, const Vector& g, double negligible, Vector& z) const = 0;
  /// y_i = 1 where x is free, else 0.
  virtual void freeIndicator(const Vector& x, Vector& y) const = 0;
  /// y_i = 1 where the set has one value alone, else 0.
  virtual void fixedIndicator(Vector& y) const = 0;
  /// y_i = a lower bound of how far x_i may move either way with the set kept, at most `atMost`; 0 on the
  /// active set.
  virtual void distanceToBoundary(const Vector& x, double atMost, Vector& y) const = 0;
  /// x moves onto the boundary where `active` is not 0: to the side that is nearer; where none is, it stays.
  virtual void activate(const Vector& active, Vector& x) const = 0;
  /// How far each entry is from "no gradient, or no room for it": the largest min(|g_i|, scale · s_i) over
  /// this rank's entries, s_i the room that −g_i has before the boundary.
  [[nodiscard]] virtual double complementarity(const Vector& x, const Vector& g, double scale) const = 0;
  /// Largest α with which the fixed x stays the minimiser over Ω when its gradient moves along s, from g to g
  /// + αs: until the first multiplier changes its sign. 0 if s touches a free entry.
  [[nodiscard]] virtual double longestMultiplierStep(const Vector& x, const Vector& g,
                                                     const Vector& s) const = 0;
  /// All d with x + d in the set. \param x  on the map of the unknowns
  [[nodiscard]] virtual RCP<const ConvexSet> shiftedBy(const Vector& x) const = 0;
  /// The directions d along which the set has no end: x + αd stays in it for every α > 0, at every feasible
  /// x.
  /// \param map  of the unknowns
  [[nodiscard]] virtual RCP<const ConvexSet> recessionCone(const RCP<const Map>& map) const = 0;
  /// Whether its boundary is curved anywhere, on any rank.
  [[nodiscard]] virtual bool isCurved() const { return false; }
  /// Frees what a curved boundary bounds, along its tangent where x is on it. Where `from` follows
  /// it already, and g leads inside, the entries become free instead. Entries at bounds that grow with others
  /// follow these.
  /// \param g      the gradient at x  \param least how long what is released is at least
  /// \param from   the last face; null for none
  virtual void followBoundary([[maybe_unused]] const Vector& x, [[maybe_unused]] const Vector& g,
                              [[maybe_unused]] double least, [[maybe_unused]] const Face* from,
                              [[maybe_unused]] Face& face) const {}
  /// y_i = how far the gradient may move along s from g until the multiplier of the boundary that x_i is on
  /// vanishes: infinity where it does not, and where x is free or fixed.
  /// \param least  multipliers that fall no faster do not count
  virtual void releases(const Vector& x, const Vector& g, const Vector& s, double least, Vector& y) const = 0;
};

} // namespace epafi::qp
