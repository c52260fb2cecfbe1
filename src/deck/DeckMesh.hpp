#pragma once

/// The mesh of a deck as the text of a mesh file of Gmsh.

#include "epafi/deck/Deck.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace epafi::deck {

/// What is to have a name in the mesh; each becomes a physical group.
struct MeshGroups {
  std::map<std::string, std::vector<GlobalOrdinal>> elements, nodes; ///< numbers, ascending
  /// Element and face, as in Surface.
  std::map<std::string, std::vector<std::pair<GlobalOrdinal, int>>> surfaces;
};

/// Format 4.1, in text; nodes and elements have the deck's numbers, facets those behind. Elements of no group
/// are left out, and nodes of no element. \throws InputError for element types that Epafi has not, a surface
/// that names a face that its element has not, and nodes off the plane of plane elements
std::string mshText(const Deck& deck, const MeshGroups& groups);

} // namespace epafi::deck
