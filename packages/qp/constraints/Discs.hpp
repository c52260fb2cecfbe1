#pragma once

/// Pairs of entries in discs |x − c| ≤ r, all others in a box: the feasible set of Tresca's friction in space
/// (r the bound of a node's tangential force), and of Coulomb's at given normal forces. Kernels as in
/// Bouchala, Dostál, Kozubek, Pospíšil, Vodstrčil, *Appl. Math. Comput.* 247 (2014).

#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/constraints/ConvexSet.hpp"

#include <cmath>
#include <vector>

namespace epafi::qp {

/// Two entries of a vector, a vector in their plane.
struct EntryPair {
  double first = 0, second = 0;

  [[nodiscard]] double dot(const EntryPair& other) const { ///< of both
    return first * other.first + second * other.second;
  }
  [[nodiscard]] double squaredNorm() const { return dot(*this); }         ///< of the length
  [[nodiscard]] double norm() const { return std::hypot(first, second); } ///< its length
  [[nodiscard]] bool isZero() const { return first == 0 && second == 0; } ///< in both
  bool operator==(const EntryPair& other) const = default;
  friend EntryPair operator+(const EntryPair& a, const EntryPair& b) {
    return {a.first + b.first, a.second + b.second};
  }
  friend EntryPair operator-(const EntryPair& a, const EntryPair& b) {
    return {a.first - b.first, a.second - b.second};
  }
  friend EntryPair operator*(double factor, const EntryPair& a) {
    return {factor * a.first, factor * a.second};
  }
};

/// A disc in the plane of two entries.
struct Disc {
  using Pair = EntryPair; ///< short for it

  LocalOrdinal first = 0, second = 0; ///< the entries, of this rank
  double radius = 0;                  ///< r ≥ 0; with 0 the pair is fixed
  Pair centre{};                      ///< c
  LocalOrdinal leader = 0;            ///< the entry with which the radius grows, if its slope is not 0
  double slope = 0;                   ///< of r over that entry

  /// Whether x is inside of the circle, and not on it but for round-off.
  [[nodiscard]] bool isFree(const Pair& x) const;
  /// (x − c)/|x − c|; 0 at the centre.
  [[nodiscard]] Pair outward(const Pair& x) const;
  [[nodiscard]] Pair project(const Pair& x) const; ///< the nearest point of the disc
  /// β: on the circle what of g leads along it, or with all of it into the disc; 0 if no longer than
  /// `negligible`, or inside.
  [[nodiscard]] Pair choppedGradient(const Pair& x, const Pair& g, double negligible = 0) const;
  /// φ̃ for the step ᾱ = `step`, inside.
  [[nodiscard]] Pair reducedFreeGradient(const Pair& x, const Pair& g, double step) const;
  /// Largest α with x − αp in the disc, x being in it.
  [[nodiscard]] double maxFeasibleStep(const Pair& x, const Pair& p) const;
};

class Discs final : public ConvexSet {
public:
  /// \param box    of all entries; what it says of those in discs counts nothing
  /// \param discs  of this rank, no entry in two of them, ascending by their first entries
  /// \param map    of the unknowns
  Discs(const Box& box, std::vector<Disc> discs, const RCP<const Map>& map);

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
  /// A box: discs have an end in every direction.
  [[nodiscard]] RCP<const ConvexSet> recessionCone(const RCP<const Map>& map) const override;
  [[nodiscard]] bool isCurved() const override { return true; }
  void followBoundary(const Vector& x, const Vector& g, double least, const Face* from,
                      Face& face) const override;
  void releases(const Vector& x, const Vector& g, const Vector& s, double least, Vector& y) const override;

private:
  [[nodiscard]] Vector withoutPairs(const Vector& x) const;
  RCP<const Map> map_;
  Box box_; ///< without bounds in the discs' entries
  std::vector<Disc> discs_;
};

} // namespace epafi::qp
