#pragma once

/// Elements that their neighbours hold in form. Quadrilaterals of 8 nodes and hexahedra of 20, integrated by
/// two points along each axis, have motions without energy beside the rigid ones: of a quadrilateral one, of
/// a hexahedron six, two in each plane of two axes. No neighbour in the plane of such a motion can take part
/// in it, but a row of hexahedra along the third axis can as a whole. A prism of 6 nodes, integrated by two
/// points, can twist; so can a column of them, but none with a neighbour at one of its sides.

#include "epafi/mesh/Mesh.hpp"

#include <algorithm>
#include <vector>

namespace epafi::mesh {

/// Whether an element has neighbours along all axes but one (a prism: one at a side), so that it has no such
/// motion together with them; others have none at all.
/// \param isPresent  isPresent(element) of neighbours: whether they count
template <class IsPresent>
bool isBraced(const Mesh& mesh, GlobalOrdinal element, const IsPresent& isPresent) {
  const ElementNodes nodes(mesh, element);
  const bool isPrism = nodes.type() == CellType::prism;
  if (!isPrism && !isSerendipity(nodes.type()))
    return true;
  std::vector<GlobalOrdinal> neighbours;
  mesh.elementNeighbours(element, neighbours);
  std::erase_if(neighbours, [&](GlobalOrdinal other) { return !isPresent(other); });
  if (dimensionOf(mesh.cellType()) == 2)
    return !neighbours.empty();
  const auto has = [&](GlobalOrdinal other, GlobalOrdinal node) {
    const ElementNodes others(mesh, other);
    return std::find(others.begin(), others.end(), node) != others.end();
  };
  if (isPrism)
    return std::any_of(neighbours.begin(), neighbours.end(), [&](GlobalOrdinal other) {
      return std::count_if(nodes.begin(), nodes.end(),
                           [&](GlobalOrdinal node) { return has(other, node); }) == mostFacetCorners;
    });
  return std::any_of(nodes.begin(), nodes.end(), [&](GlobalOrdinal node) { // of faces of different axes
    return std::count_if(neighbours.begin(), neighbours.end(),
                         [&](GlobalOrdinal other) { return has(other, node); }) > 1;
  });
}

} // namespace epafi::mesh
