#pragma once

/// Bodies to cut into simplices and to split, and what every split of them keeps.

#include "SampleCells.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/SimplexMesh.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace epafi::test {

/// A mesh as arrays with all its surfaces, its nodes moved by `map`; every third element is in the group
/// "third".
template <class Map>
mesh::MeshArrays moved(const mesh::Mesh& mesh, const Map& map) {
  mesh::MeshArrays arrays;
  arrays.name = "Body 'sample'";
  arrays.cellType = mesh.cellType();
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
    arrays.points.push_back(map(mesh.point(node)));
    arrays.nodeTags.push_back(node);
  }
  arrays.groups = {{"third", {}}};
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    for (const GlobalOrdinal node : mesh::ElementNodes(mesh, element))
      arrays.cells.push_back(static_cast<LocalOrdinal>(node));
    arrays.elementTags.push_back(element);
    if (element % 3 == 0)
      arrays.groups[0].elements.push_back(static_cast<LocalOrdinal>(element));
  }
  for (const std::string& name : mesh.surfaceNames()) {
    mesh::NamedFacets& facets = arrays.surfaces.emplace_back(mesh::NamedFacets{name, {}});
    const mesh::Surface surface = mesh.surface(name);
    for (std::size_t f = 0; f < surface.numFacets(); ++f)
      for (int i = 0; i < numCornersOf(surface.facetType); ++i)
        facets.nodes.push_back(static_cast<LocalOrdinal>(surface.facet(f)[i]));
  }
  return arrays;
}

/// The unit square (elements in z: 0) or cube, the inner nodes of its grid moved by up to a quarter of a
/// cell, in simplices.
inline mesh::SimplexMesh unevenGrid(const std::array<int, 3>& elements, std::uint32_t seed = 1) {
  const mesh::StructuredMesh grid({{0, 0, 0}, {1, 1, 1}}, elements);
  SignedRandomNumbers random(seed);
  const auto shaken = [&](Point point) {
    bool isInside = true;
    for (int d = 0; d < grid.dimension(); ++d)
      isInside = isInside && std::abs(point[d] - 0.5) < 0.49;
    for (std::size_t d = 0; isInside && d < static_cast<std::size_t>(grid.dimension()); ++d)
      point[d] += 0.25 / elements[d] * random();
    return point;
  };
  return simplicesOf(mesh::UnstructuredMesh(moved(grid, shaken)));
}

/// A quarter of a ring of radii 1 and 2 round the origin, in space of height 1, in bricks of order 2; its
/// surface "right" is the outer arc, "left" the inner one. \param elements along the radius, round it, and in
/// z (0: in the plane)
inline mesh::MeshArrays quarterRing(const std::array<int, 3>& elements) {
  return moved(mesh::StructuredMesh({{1, 0, 0}, {2, 1, 1}}, elements, 2), [](const Point& x) {
    const double angle = 0.5 * std::numbers::pi * x[1];
    return Point{x[0] * std::cos(angle), x[0] * std::sin(angle), x[2]};
  });
}

/// Area or volume of each element.
inline std::vector<double> measuresOf(const mesh::Mesh& mesh) {
  std::vector<double> measures;
  std::vector<Point> points;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    mesh.elementPoints(element, points);
    measures.push_back(measureOf(mesh::ElementNodes(mesh, element).type(), points));
  }
  return measures;
}

inline double sumOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

inline double measureOfGroup(const mesh::Mesh& mesh, const std::string& name) {
  const std::vector<double> measures = measuresOf(mesh);
  double sum = 0;
  for (const GlobalOrdinal element : mesh.group(name))
    sum += measures[element];
  return sum;
}

/// Length or area of a surface.
inline double measureOfSurface(const mesh::Mesh& mesh, const std::string& name) {
  const mesh::Surface surface = mesh.surface(name);
  std::vector<Point> points;
  std::vector<double> shares;
  double sum = 0;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    mesh.pointsAt(surface.facet(f), points);
    shares.resize(points.size());
    nodalShares(surface.typeOf(f), points, shares);
    sum += sumOf(shares);
  }
  return sum;
}

/// As a mesh, which refuses what is not sound, hanging nodes above all. What its surfaces do not show is
/// inside: no facet has lost its neighbour. Precondition: every facet of the border is on one surface.
inline mesh::UnstructuredMesh soundBody(const mesh::SimplexMesh& mesh, int order = 1) {
  mesh::UnstructuredMesh body(arraysOf(mesh, order));
  std::size_t alone = 0, onSurfaces = 0;
  std::vector<GlobalOrdinal> neighbours;
  for (GlobalOrdinal element = 0; element < body.numElements(); ++element) {
    body.elementNeighbours(element, neighbours);
    alone += facetsOf(body.cellType()).size() - neighbours.size();
  }
  for (const std::string& name : body.surfaceNames())
    onSurfaces += body.surface(name).numFacets();
  EXPECT_EQ(alone, onSurfaces);
  return body;
}

} // namespace epafi::test
