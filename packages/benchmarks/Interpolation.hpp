#pragma once

/// From a coarse mesh to a fine one, and from a solution to the face that it suggests.

#include "epafi/benchmarks/Grid.hpp"

namespace epafi::benchmarks {

/// The bilinear interpolation from one grid to another of the same rectangle, 0 on the border: (fine size) × (coarse
/// size), not more than four entries a row. The grids need not be nested. Each rank fills the rows of its fine
/// unknowns.
/// \param coarse, fine        with ny > 1
/// \param coarseMap, fineMap  of the unknowns
/// Collective.
RCP<CrsMatrix> bilinearInterpolation(const Grid& coarse, const RCP<const Map>& coarseMap, const Grid& fine,
                                     const RCP<const Map>& fineMap);

} // namespace epafi::benchmarks
