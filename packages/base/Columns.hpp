#pragma once

/// The columns of multivectors, one pair after the other, without an allocation where there is but one.

#include "epafi/base/Types.hpp"

#include <Tpetra_Vector.hpp>

#include <cstddef>

namespace epafi {

/// Calls action(x_j, y_j) with every column as a Vector. Precondition: as many columns in y as in x.
template <class Action>
void forEachColumn(const MultiVector& x, MultiVector& y, Action action) {
  const auto* singleX = dynamic_cast<const Vector*>(&x);
  auto* singleY = dynamic_cast<Vector*>(&y);
  if (singleX != nullptr && singleY != nullptr) {
    action(*singleX, *singleY);
    return;
  }
  for (std::size_t column = 0; column < x.getNumVectors(); ++column)
    action(*x.getVector(column), *y.getVectorNonConst(column));
}

} // namespace epafi
