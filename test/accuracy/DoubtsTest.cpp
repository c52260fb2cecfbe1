#include "epafi/accuracy/Doubts.hpp"
#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace epafi::accuracy {
namespace {

/// A ring sector of quadrilaterals between radii 1 and 2, or, extruded by 1, of hexahedra; its inner side is
/// "inner".
mesh::MeshArrays sector(int parts, double step, bool isSolid) {
  mesh::MeshArrays arrays;
  arrays.name = "sector";
  arrays.cellType = isSolid ? mesh::CellType::hexahedron : mesh::CellType::quadrilateral;
  const int layers = isSolid ? 2 : 1, perLayer = 2 * (parts + 1);
  for (int z = 0; z < layers; ++z)
    for (int i = 0; i <= parts; ++i)
      for (const double radius : {1.0, 2.0})
        arrays.points.push_back({radius * std::cos(i * step), radius * std::sin(i * step), 1.0 * z});
  mesh::NamedFacets inner{"inner", {}};
  for (int i = 0; i < parts; ++i) {
    const int a = 2 * i;
    for (int z = 0; z < layers; ++z)
      for (const int node : {a, a + 1, a + 3, a + 2})
        arrays.cells.push_back(node + perLayer * z);
    inner.nodes.insert(inner.nodes.end(), {a, a + 2});
    if (isSolid)
      inner.nodes.insert(inner.nodes.end(), {a + 2 + perLayer, a + perLayer});
    arrays.elementTags.push_back(i);
  }
  for (std::size_t n = 0; n < arrays.points.size(); ++n)
    arrays.nodeTags.push_back(n);
  arrays.surfaces.push_back(inner);
  return arrays;
}

double sagOf(const mesh::UnstructuredMesh& mesh) {
  return facetSag(mesh, mesh.surface("inner"));
}

/// A chord of the angle θ deviates from its arc by R (1 − cos θ/2).
TEST(DoubtsTest, SagIsWhatChordsDeviateFromTheirArc) {
  constexpr double angle = 0.1;
  const double sag = 1 - std::cos(angle / 2);
  for (const bool isSolid : {false, true})
    for (const int order : {1, 2}) { // quadratic elements with straight edges are no better
      mesh::MeshArrays arrays = sector(8, angle, isSolid);
      if (order == 2)
        arrays = mesh::completed(std::move(arrays), false);
      EXPECT_NEAR(sagOf(mesh::UnstructuredMesh(std::move(arrays))), sag, 0.01 * sag) << isSolid << order;
    }
}

TEST(DoubtsTest, NeitherCurvedFacetsNorEdgesOfABodyHaveSag) {
  mesh::MeshArrays arrays = mesh::completed(sector(8, 0.1, false), false);
  for (Point& point : arrays.points) // onto the circles
    if (const double radius = std::hypot(point[0], point[1]), whole = std::round(radius);
        std::abs(radius - whole) < 0.01)
      for (double& coordinate : point)
        coordinate *= whole / radius;
  EXPECT_EQ(sagOf(mesh::UnstructuredMesh(std::move(arrays))), 0);
  EXPECT_EQ(sagOf(mesh::UnstructuredMesh(sector(3, 0.8, false))), 0);
}

TEST(DoubtsTest, BodiesLockWherePoissonsRatioIsNearOneHalfInAnyRegion) {
  scene::Body body;
  body.physics = fem::Physics::planeStrain;
  body.material.poissonsRatio = 0.3;
  EXPECT_FALSE(locks(body));
  body.regions.emplace_back().material.poissonsRatio = 0.4999;
  EXPECT_TRUE(locks(body));
  body.physics = fem::Physics::planeStress;
  EXPECT_FALSE(locks(body));
}

} // namespace
} // namespace epafi::accuracy
