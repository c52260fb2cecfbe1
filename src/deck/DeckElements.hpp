#pragma once

/// What the element types of decks are: their physics, their nodes beside those of Gmsh, their faces.

#include "epafi/deck/Deck.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace epafi::deck {

struct ElementForm {
  std::string physics; ///< as a scene's XML calls it
  int dimension = 3;
  int kind = 0;           ///< Gmsh's number of it
  int facetKind = 0;      ///< of its facets, with corners alone
  bool isReduced = false; ///< by fewer points than are exact
  /// Places of the deck's nodes in Gmsh's order.
  std::vector<int> places;
  /// Corners of each face, those of S1 first, as places among the deck's nodes.
  std::vector<std::vector<int>> faces;
  std::string name{}; ///< such as C3D20R

  /// Whether there are two ways to integrate it here (mesh::hasReducedRule), of which the type is one.
  [[nodiscard]] bool mayBeReduced() const { return kind == 6 || kind == 16 || kind == 17 || kind == 18; }
  /// Whether one of it alone is loose in itself: all that are reduced but prisms of 15 nodes.
  [[nodiscard]] bool isLooseAlone() const { return isReduced && kind != 18; }
};

/// Places of the corners between which an element's other nodes lie, one by one; empty of linear elements.
std::span<const std::array<int, 2>> edgesOf(const ElementForm& form);

/// Whether it is that of solids of revolution about the y-axis.
inline bool isOfRevolution(const ElementForm& form) {
  return form.physics == "axisymmetric";
}

/// \throws InputError with the place of the type's first card if Epafi has no such element
const ElementForm& formOf(const Elements& elements);

} // namespace epafi::deck
