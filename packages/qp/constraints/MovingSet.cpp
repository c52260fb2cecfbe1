#include "epafi/qp/constraints/MovingSet.hpp"

#include "epafi/base/AccurateSum.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::qp {

double moveWithBounds(const ConvexSet& old, const ConvexSet& set, Vector& x) {
  constexpr double atBound = 1e-9; // beside the largest entry
  const double largest = x.normInf();
  const Vector before(x, Teuchos::Copy);
  Vector room(x.getMap()), held(x.getMap());
  old.distanceToBoundary(x, largest, room);
  {
    const auto rooms = room.getData();
    const auto isHeld = held.getDataNonConst();
    for (Teuchos_Ordinal i = 0; i < rooms.size(); ++i)
      isHeld[i] = rooms[i] <= atBound * largest ? 1 : 0;
  }
  set.activate(held, x);
  set.project(x);
  set.distanceToBoundary(x, largest, room); // of bounds that were 0 and have no side to move to
  AccurateSum sum;
  const auto here = x.getData(), there = before.getData(), isHeld = held.getData(), rooms = room.getData();
  for (Teuchos_Ordinal i = 0; i < here.size(); ++i) {
    const double moved = std::hypot(here[i] - there[i], isHeld[i] != 0 ? rooms[i] : 0);
    sum.add(moved * moved);
  }
  sumOverRanks(*x.getMap()->getComm(), {&sum, 1});
  return std::sqrt(sum.value());
}

void Relaxation::step(const Vector& x, Vector& y) {
  constexpr double least = 0.1;
  Vector misfit(x, Teuchos::Copy);
  misfit.update(-1.0, y, 1.0);
  if (last_) {
    last_->update(1.0, misfit, -1.0);
    if (const double squared = accurateDot(*last_, *last_); squared > 0)
      share_ = std::clamp(share_ * (1 - accurateDot(*last_, misfit) / squared), least, 1.0);
  }
  y.update(share_, x, 1 - share_);
  last_.emplace(misfit, Teuchos::Copy);
}

} // namespace epafi::qp
