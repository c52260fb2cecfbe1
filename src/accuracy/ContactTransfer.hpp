#pragma once

/// Forces of contact on one mesh in the terms of a finer one.

#include "epafi/base/Types.hpp"
#include "epafi/model/Decompose.hpp"

namespace epafi::accuracy {

/// Puts into `start` multipliers of contact: the pressure at the nearest row of the same contact on the other
/// mesh, times the row's area. So rows are closed where they were there; how far they are open next to a rim
/// is not known better. (Residuals of interpolated displacements have any sign there.) Friction has the
/// direction there, and the same share of its bound.
/// \param from    decomposition of a scene on a coarse mesh; `lambda` its solution, on its multiplierMap
/// \param to      decomposition of the same scene on another mesh: the same contacts in the same order
/// \param start   on the multiplierMap of `to`; rows of ties and gluing stay
/// O(n log n). Collective.
void transferContact(const model::Decomposition& from, const Vector& lambda, const model::Decomposition& to,
                     Vector& start);

} // namespace epafi::accuracy
