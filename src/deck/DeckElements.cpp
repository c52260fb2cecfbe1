#include "epafi/deck/DeckElements.hpp"

#include "epafi/base/Errors.hpp"

#include <map>
#include <numeric>

namespace epafi::deck {
namespace {

using Faces = std::vector<std::vector<int>>;

const Faces ofTriangle{{0, 1}, {1, 2}, {2, 0}}, ofQuadrilateral{{0, 1}, {1, 2}, {2, 3}, {3, 0}},
    ofTetrahedron{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}},
    ofPrism{{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}},
    ofHexahedron{{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

std::vector<int> inOrder(int number) {
  std::vector<int> places(number);
  std::iota(places.begin(), places.end(), 0);
  return places;
}

/// Both count corners first. Gmsh has the edges of a tetrahedron in the order 01 12 20 03 23 13, those of a
/// prism as 01 02 03 12 14 25 34 35 45, those of a hexahedron as 01 03 04 12 15 23 26 37 45 47 56 67.
const std::vector<int> places10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8},
    places15{0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10},
    places20{0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14};

const std::map<std::string, ElementForm>& types() {
  static const std::map<std::string, ElementForm> all = [] {
    std::map<std::string, ElementForm> known{
        {"C3D4", {"elasticity 3-D", 3, 4, 2, false, inOrder(4), ofTetrahedron}},
        {"C3D10", {"elasticity 3-D", 3, 11, 2, false, places10, ofTetrahedron}},
        {"C3D6", {"elasticity 3-D", 3, 6, 2, true, inOrder(6), ofPrism}},
        {"C3D15", {"elasticity 3-D", 3, 18, 2, true, places15, ofPrism}},
        {"C3D8", {"elasticity 3-D", 3, 5, 3, false, inOrder(8), ofHexahedron}},
        {"C3D20", {"elasticity 3-D", 3, 17, 3, false, places20, ofHexahedron}},
        {"C3D20R", {"elasticity 3-D", 3, 17, 3, true, places20, ofHexahedron}}};
    for (const auto& [letters, physics] : {std::pair("CPE", "plane strain"), std::pair("CPS", "plane stress"),
                                           std::pair("CAX", "axisymmetric")}) {
      const std::string name(letters);
      known[name + "3"] = {physics, 2, 2, 1, false, inOrder(3), ofTriangle};
      known[name + "6"] = {physics, 2, 9, 1, false, inOrder(6), ofTriangle};
      known[name + "4"] = {physics, 2, 3, 1, false, inOrder(4), ofQuadrilateral};
      known[name + "8"] = {physics, 2, 16, 1, false, inOrder(8), ofQuadrilateral};
      known[name + "8R"] = {physics, 2, 16, 1, true, inOrder(8), ofQuadrilateral};
    }
    for (auto& [name, form] : known)
      form.name = name;
    return known;
  }();
  return all;
}

using Edges = std::vector<std::array<int, 2>>;
const Edges edges6{{0, 1}, {1, 2}, {2, 0}}, edges8{{0, 1}, {1, 2}, {2, 3}, {3, 0}},
    edges10{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
    edges15{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
    edges20{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

} // namespace

std::span<const std::array<int, 2>> edgesOf(const ElementForm& form) {
  switch (form.places.size()) {
  case 6:
    return form.dimension == 2 ? std::span<const std::array<int, 2>>(edges6)
                               : std::span<const std::array<int, 2>>();
  case 8:
    return form.dimension == 2 ? std::span<const std::array<int, 2>>(edges8)
                               : std::span<const std::array<int, 2>>();
  case 10:
    return edges10;
  case 15:
    return edges15;
  case 20:
    return edges20;
  default:
    return {};
  }
}

const ElementForm& formOf(const Elements& elements) {
  const auto found = types().find(elements.type);
  if (found == types().end())
    throw InputError(
        text(elements.place) + ": *ELEMENT: elements of the type " + elements.type +
        " are not solved here; solids are meshed in C3D4, C3D6, C3D8, C3D10, C3D15, C3D20 or C3D20R, plane "
        "bodies in CPE or CPS, solids of revolution in CAX elements of 3, 4, 6 or 8 nodes");
  return found->second;
}

} // namespace epafi::deck
