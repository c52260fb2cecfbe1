#pragma once

/// Sets whose bounds follow the solution (QuadraticProgram::setAt).

#include "epafi/qp/constraints/ConvexSet.hpp"

#include <Tpetra_Vector.hpp>

#include <optional>

namespace epafi::qp {

/// Moves x, a solution within `old`, into `set`, whose bounds differ, and along with its bounds where it is
/// at them; returns how far. Collective.
double moveWithBounds(const ConvexSet& old, const ConvexSet& set, Vector& x);

/// Relaxation of a fixed point y ← y + θ(x(y) − y): Irons, Tuck, *Int. J. Numer. Methods Eng.* 1 (1969).
class Relaxation {
public:
  /// y moves towards x. Collective.
  void step(const Vector& x, Vector& y);

private:
  std::optional<Vector> last_; ///< x(y) − y of the step before
  double share_ = 1;           ///< θ
};

} // namespace epafi::qp
