#pragma once

/// Sections of which a deck has forces printed (*SECTION PRINT).

#include "epafi/deck/DeckBodies.hpp"

#include <Eigen/Core>

#include <optional>
#include <utility>
#include <vector>

namespace epafi::deck {

struct DeckSection {
  /// Elements on the side that the surface is defined from, those at its edges too, each with its nodes in
  /// it.
  std::vector<std::pair<GlobalOrdinal, GlobalOrdinal>> nodesOfElements;
  // Of facets with straight edges between corners.
  double area = 0;
  Eigen::Vector3d centre{0, 0, 0}, normal{0, 0, 0}; ///< of gravity; the mean, of length 1 but if it is 0
};

/// Nothing of a surface of nodes, in the plane, or where what touches the surface hangs together around it.
std::optional<DeckSection> sectionAt(const Deck& deck, const DeckBodies& bodies, const Surface& surface);

} // namespace epafi::deck
