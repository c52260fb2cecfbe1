#pragma once

/// Elements that their neighbours hold in form. Quadrilaterals of 8 nodes and hexahedra of 20, integrated by
/// two points along each axis, have motions without energy beside the rigid ones: of a quadrilateral one, of
/// a hexahedron six, two in each plane of two axes. No neighbour in the plane of such a motion can take part
/// in it, but a row of hexahedra along the third axis can as a whole.

#include "epafi/mesh/Mesh.hpp"

#include <algorithm>
#include <vector>

namespace epafi::mesh {

/// Whether an element has neighbours along all axes but one, so that it has no such motion together with
/// them. Precondition: it is a quadrilateral or a hexahedron.
/// \param isPresent  isPresent(element) of neighbours: whether they count
template <class IsPresent>
bool isBraced(const Mesh& mesh, GlobalOrdinal element, const IsPresent& isPresent) {
  std::vector<GlobalOrdinal> neighbours;
  mesh.elementNeighbours(element, neighbours);
  std::erase_if(neighbours, [&](GlobalOrdinal other) { return !isPresent(other); });
  if (dimensionOf(mesh.cellType()) == 2)
    return !neighbours.empty();
  const auto has = [&](GlobalOrdinal other, GlobalOrdinal node) {
    const ElementNodes nodes(mesh, other);
    return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
  };
  const ElementNodes nodes(mesh, element); // only faces of different axes have nodes in common
  return std::any_of(nodes.begin(), nodes.end(), [&](GlobalOrdinal node) {
    return std::count_if(neighbours.begin(), neighbours.end(),
                         [&](GlobalOrdinal other) { return has(other, node); }) > 1;
  });
}

} // namespace epafi::mesh
