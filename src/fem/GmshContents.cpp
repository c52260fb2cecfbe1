#include "epafi/fem/GmshContents.hpp"

namespace epafi::fem {
namespace {

constexpr int pointType = 15;

} // namespace

int numNodesOfGmsh(int type) {
  // line 1, triangle, quadrilateral, tetrahedron, hexahedron, prism, pyramid 7
  constexpr std::array<int, 8> counts{0, 2, 3, 4, 4, 8, 6, 5};
  if (type == pointType)
    return 1;
  return type > 0 && type < 8 ? counts[static_cast<std::size_t>(type)] : 0;
}

int dimensionOfGmsh(int type) {
  return type == pointType ? 0 : type == 1 ? 1 : type < 4 ? 2 : 3;
}

std::string notLinear(int type, GlobalOrdinal element) {
  return "element " + std::to_string(element) + " is of Gmsh's kind " + std::to_string(type) +
         ", of second or higher order or unknown; only linear elements are allowed, so mesh with "
         "Mesh.ElementOrder = 1";
}

} // namespace epafi::fem
