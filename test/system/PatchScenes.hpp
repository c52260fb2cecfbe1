#pragma once

/// What the patch tests solve: two blocks under pressure, of any elements, from any source, one on the other.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"
#include "support/TurnedMesh.hpp"

namespace epafi::test {

inline constexpr double pressure = 3;

/// Where the elements come from: the program's own boxes (of simplices: the same in a file), a file of them
/// turned and moved away, the same of curved elements of order 2, or a geometry that Gmsh meshes as it likes
/// but for the joint.
enum class Source { structured, turned, curved, gmsh };

struct Kind {
  Physics physics;
  mesh::CellType cell;
  Source source;
  int order = 1;
  int lowerOrder = order;          ///< of the lower block
  mesh::CellType lowerCell = cell; ///< likewise
  int lowerElements = 0;           ///< along the joint, if the lower block is meshed apart
  int upperElements = 0;           ///< along the joint, if not as usual
  bool isSerendipity = false;      ///< without inner nodes
  bool isReduced = false;          ///< integrated by fewer points
  Cut cut = Cut::none;             ///< of the cells, if these are not simplices

  [[nodiscard]] int dimension() const { return mesh::dimensionOf(cell); }
  [[nodiscard]] epafi::test::Placement placement() const {
    return source == Source::turned || source == Source::curved
               ? epafi::test::placed(dimension(), 0.7, {2, -1, dimension() == 3 ? 3.0 : 0.0})
               : epafi::test::Placement{};
  }
};

bool isSimplex(mesh::CellType cell);

/// What the upper block is pressed against.
enum class Below { block, tiedBlock, blockAtADistance, plane };

inline constexpr double distance = 0.01;

/// Two blocks, one on the other, on a sliding floor, or the upper one alone on a plane in the lower one's
/// place; the upper one floats and is pressed down.
scene::Scene stack(const Kind& kind, Below below, const epafi::test::MeshFolder& folder);

} // namespace epafi::test
