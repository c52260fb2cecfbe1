#pragma once

/// Stress and strain inside the elements of a solid, on rank 0.

#include "epafi/fem/PointStates.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <vector>

namespace epafi::output {

struct ElementPoint {
  GlobalOrdinal element = 0; ///< as numbered in the body
  int point = 0;             ///< from 1 on, in the order of fem::pointStates()
  fem::PointState state;
};

/// At the points by which elements are integrated fully, or by fewer; ascending by element and point, empty
/// on all ranks but 0. Collective. Precondition: elasticity in space.
std::vector<ElementPoint> gatherElementPoints(const simulation::SolvedScene& solved, int body,
                                              fem::Integration integration);

} // namespace epafi::output
