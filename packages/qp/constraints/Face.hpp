#pragma once

/// Where an iteration may move from a point of Ω as if there were no bounds. Parts of the boundary that are
/// flat hold an entry or let it go; on a circle a pair of entries may still move along the tangent, and pays
/// for the circle's curvature.

#include "epafi/base/Types.hpp"

#include <Tpetra_Vector.hpp>

#include <array>
#include <vector>

namespace epafi::qp {

/// A pair of entries on a circle: it may move along t, perpendicular to the radius.
struct CircleTangent {
  LocalOrdinal first = 0, second = 0; ///< the entries, of this rank
  std::array<double, 2> along{};      ///< t, of length 1; the outward normal is (t₂, −t₁)
  double origin = 0;                  ///< tᵀx where the tangent was taken
  double radius = 0;                  ///< of the circle, > 0
  /// κ ≥ 0: the multiplier of ½(|x|² − r²), the least change of the gradient along t that the circle asks for
  double curvature = 0;

  /// tᵀ of the pair's part of a vector, given as this rank's entries.
  template <class Entries>
  [[nodiscard]] double component(const Entries& values) const {
    return along[0] * values[first] + along[1] * values[second];
  }
  /// The same along the outward normal.
  template <class Entries>
  [[nodiscard]] double outward(const Entries& values) const {
    return along[1] * values[first] - along[0] * values[second];
  }
};

/// An entry on a bound that grows with another entry, its leader: as this one moves by d, so it moves by
/// share · d.
struct Follower {
  LocalOrdinal leader = 0, entry = 0; ///< of this rank
  double share = 0;
};

/// Z = 1 where an entry may move and 0 where it may not, ttᵀ for a pair on its circle, and K = κttᵀ there, 0
/// elsewhere: the Hessian on the face is Z(A + K)Z. Where bounds grow with entries, T = Z and what follows.
class Face {
public:
  /// Nothing may move. \param map of the unknowns
  explicit Face(const RCP<const Map>& map) : isFree(map) {}

  Vector isFree;                       ///< 1 where an entry may move, along a tangent too, else 0
  std::vector<CircleTangent> tangents; ///< of this rank, with their first entries ascending
  std::vector<Follower> followers;     ///< of this rank; their leaders may move

  /// y = Zx. \param y may be x. Not collective, like all that follows.
  void restrict(const Vector& x, Vector& y) const;
  /// Adds to a direction Zy what follows it: Ty. Not collective.
  void addFollowers(Vector& y) const;
  /// κ of each tangent, from the gradient g where it was taken.
  void curve(const Vector& g);
  /// y += factor · Kp.
  void addBending(const Vector& p, double factor, Vector& y) const;
  /// y += factor · K(x − x0), x0 where the tangents were taken.
  void addBendingFromOrigin(const Vector& x, double factor, Vector& y) const;
  /// y ← Wy, W = (1 + κ/a)^−½ along tangents, else 1: what makes M ≈ A⁻¹ fit A + K. \param stiffness a, that
  /// of A in these entries
  void weigh(double stiffness, Vector& y) const;
};

/// to = from; allocates nothing once `to` has had as many tangents.
void copy(const Face& from, Face& to);

} // namespace epafi::qp
