#pragma once

/// Blocks one on the other with their contacts and ties, as layouts.

#include "support/TurnedMesh.hpp"

#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"
#include "epafi/model/SceneContacts.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace epafi::model {

using contact::ContactLayout;
using scene::SurfaceContact;
using Kind = SurfaceContact::Kind;
using Side = SurfaceContact::Side;

/// How blocks are meshed.
struct Meshing {
  int dimension = 2, order = 1;
  bool isSimplex = false;
};

inline const std::vector<Meshing> all{{2, 1, false}, {2, 2, false}, {2, 2, true}, {3, 1, false},
                                      {3, 1, true},  {3, 2, false}, {3, 2, true}};

inline std::string toString(const Meshing& meshing) {
  return std::to_string(meshing.dimension) + "-D, order " + std::to_string(meshing.order) +
         (meshing.isSimplex ? ", simplices" : "");
}

inline double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Blocks one on the other, and a scene of them.
struct Blocks {
  Meshing meshing;
  scene::Scene scene{};
  std::vector<BodyLayout> bodies{};

  /// From `left` to `right`, of a number of elements, its last coordinate from `low` to `high`; "top" and
  /// "bottom" are cut at the middle into "top left", …, their inner halves are "top inner", …, and "skin" is
  /// all of its outside but what is opposite to the joint.
  void add(const std::string& name, double left, double right, double low, double high, int elements) {
    const bool isPlane = meshing.dimension == 2;
    const mesh::StructuredMesh grid(isPlane ? mesh::Box{{left, low, 0}, {right, high, 0}}
                                            : mesh::Box{{left, 0, low}, {right, 1, high}},
                                    isPlane ? std::array{elements, 2, 0} : std::array{elements, 2, 2});
    mesh::MeshArrays arrays = epafi::test::arraysOf(grid, {}, meshing.isSimplex);
    const std::size_t perFacet = numNodesOf(facetTypeOf(arrays.cellType));
    const double middle = (left + right) / 2;
    std::vector<mesh::NamedFacets> more;
    for (const mesh::NamedFacets& facets : arrays.surfaces)
      if (facets.name == "top" || facets.name == "bottom") {
        mesh::NamedFacets halves[2] = {{facets.name + " left", {}}, {facets.name + " right", {}}},
                          inner{facets.name + " inner", {}};
        for (std::size_t f = 0; f < facets.nodes.size(); f += perFacet) {
          const auto begin = facets.nodes.begin() + static_cast<std::ptrdiff_t>(f),
                     end = begin + static_cast<std::ptrdiff_t>(perFacet);
          double centre = 0;
          for (auto node = begin; node != end; ++node)
            centre += arrays.points[*node][0] / static_cast<double>(perFacet);
          auto& half = halves[centre < middle ? 0 : 1].nodes;
          half.insert(half.end(), begin, end);
          if (std::abs(centre - middle) < (right - left) / 4)
            inner.nodes.insert(inner.nodes.end(), begin, end);
        }
        more.insert(more.end(), {halves[0], halves[1], inner});
      }
    mesh::NamedFacets skin{"skin", {}};
    for (const mesh::NamedFacets& facets : arrays.surfaces)
      if (facets.name != (low < 0 ? "bottom" : "top"))
        skin.nodes.insert(skin.nodes.end(), facets.nodes.begin(), facets.nodes.end());
    more.push_back(skin);
    arrays.surfaces.insert(arrays.surfaces.end(), more.begin(), more.end());
    if (meshing.order == 2)
      arrays = mesh::completed(std::move(arrays), false);
    bodies.push_back({name, std::make_unique<const mesh::UnstructuredMesh>(std::move(arrays)), nullptr, 0});
    scene::Body body;
    body.name = name;
    body.physics = isPlane ? fem::Physics::planeStrain : fem::Physics::elasticity3d;
    scene.bodies.push_back(body);
  }

  SurfaceContact& join(const std::string& name, const std::string& lower, const std::string& upper,
                       Kind kind = Kind::contact) {
    SurfaceContact contact;
    contact.name = name;
    contact.firstSurface = lower;
    contact.second = 1;
    contact.secondSurface = upper;
    contact.kind = kind;
    return scene.contacts.emplace_back(contact);
  }

  [[nodiscard]] SceneContacts layout() const { return layoutContacts(scene, bodies, {}); }
};

inline Blocks stacked(const Meshing& meshing, int lower, int upper, double gap = 0) {
  Blocks blocks{meshing};
  blocks.add("lower", 0, 2, -1, 0, lower);
  blocks.add("upper", 0, 2, gap, gap + 1, upper);
  return blocks;
}

/// Area of a contact under an even pressure 1: its part of the forces.
inline double ownArea(const ContactLayout& layout) {
  double area = 0;
  for (std::size_t row = 0; row < layout.areas.size(); ++row)
    area += layout.portion(row) * layout.areas[row];
  return area;
}

} // namespace epafi::model
