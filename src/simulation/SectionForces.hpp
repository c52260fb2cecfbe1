#pragma once

/// What goes through a section of a body: the forces by which the elements on its one side are held.

#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <span>

namespace epafi::simulation {

/// An element on the section's side, with one of its nodes in the section.
struct SectionShare {
  int body = 0;
  GlobalOrdinal element = 0, node = 0; ///< as numbered in the body
};

struct SectionForce {
  std::array<double, 3> force{}, moment{}; ///< on these elements; about the origin
};

/// Σ (K_e u − f_e) at the nodes, f_e the loads inside of the elements and on their facets beside the section:
/// in balance with all that holds and loads what lies on this side, forces at its nodes and on its facets
/// being part of what goes through it.
/// \param shares  the same on all ranks. Collective. Precondition: elasticity in space.
SectionForce sectionForce(const SolvedScene& solved, std::span<const SectionShare> shares);

} // namespace epafi::simulation
