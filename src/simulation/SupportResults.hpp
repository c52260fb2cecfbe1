#pragma once

/// What supports hold bodies with.

#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <string>
#include <vector>

namespace epafi::simulation {

/// Force and moment of a support on its body; of membranes in z, of solids of revolution along the axis alone
/// and all around. A value that several supports hold counts with the first of them.
struct SupportResult {
  std::string body, name;
  std::array<double, 3> force{}, moment{}; ///< moment about the origin
};

/// Of each support of each body: the forces at its nodes with which stiffness, loads and contact are in
/// balance there. Sums are the same to the last digit on any number of ranks. Collective.
std::vector<SupportResult> supportResults(const SolvedScene& solved);

/// The force that supports hold each node of a body with, of this rank's slab (evenShare of the nodes); 0
/// where none does. Of solids of revolution all around, the radial force too. Collective.
std::vector<Vector3> supportForcesAtNodes(const SolvedScene& solved, int body);

} // namespace epafi::simulation
