#pragma once

/// Which rows hold while a solution is settled (Recovery.hpp).

#include "epafi/base/Collective.hpp"
#include "epafi/qp/constraints/ConvexSet.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::fetidp {

/// The rows that hold while a solution is settled: gluing, ties, and some of contact.
class HeldRows {
public:
  /// Contact that pushes. Keeps references.
  /// \param forces  what multipliers may be  \param sizes  see sizesOfRows
  HeldRows(const qp::ConvexSet& forces, const Vector& sizes, const Vector& lambda)
      : forces_(forces), sizes_(sizes), held_(lambda.getMap()), nearest_(lambda.getMap()) {
    forces_.freeIndicator(lambda, held_);
  }
  [[nodiscard]] const Vector& indicator() const { return held_; } ///< 1 where they hold, else 0
  /// Contacts that pull hold no longer, by more than round-off, and those that penetrate by more than
  /// `allowed` do; returns whether there are any. Collective.
  bool change(const Vector& lambda, const Vector& slack, double allowed) {
    const double roundOff = 1e-9 * lambda.normInf();
    nearest_.assign(lambda);
    forces_.project(nearest_);
    const auto isHeld = held_.getDataNonConst();
    const auto force = lambda.getData(), allowedForce = nearest_.getData(), room = slack.getData();
    bool isAny = false;
    for (LocalOrdinal i = 0; i < force.size(); ++i)
      if (isHeld[i] != 0 ? std::abs(force[i] - allowedForce[i]) > roundOff : room[i] < -allowed) {
        isHeld[i] = 1 - isHeld[i];
        isAny = true;
      }
    return holdsAnywhere(*held_.getMap()->getComm(), isAny);
  }
  /// Largest gap. Collective.
  [[nodiscard]] double largestOpen(const Vector& slack) const {
    double largest = 0;
    const auto isHeld = held_.getData(), jump = slack.getData(), size = sizes_.getData();
    for (LocalOrdinal i = 0; i < jump.size(); ++i)
      largest = std::max(largest, isHeld[i] * std::abs(jump[i]) / size[i]);
    return maxOverRanks(*held_.getMap()->getComm(), largest);
  }

private:
  const qp::ConvexSet& forces_;
  const Vector& sizes_;
  Vector held_, nearest_; ///< 1 where rows hold; work
};

} // namespace epafi::fetidp
