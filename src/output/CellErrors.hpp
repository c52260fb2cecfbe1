#pragma once

/// Where the mesh is too coarse: the estimated discretisation error of every cell.

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/output/SolvedScene.hpp"

#include <vector>

namespace epafi::output {

/// η_T, the error in the energy norm of each cell of a body, of this rank's slab (evenShare of the cells). The root of the
/// sum of their squares over all bodies is the estimate. Collective.
std::vector<double> cellErrors(const SolvedScene& solved, const accuracy::ErrorEstimate& estimate, int body);

} // namespace epafi::output
