#include "epafi/contact/UnitedSurface.hpp"

#include "support/TurnedMesh.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace epafi {
namespace {

using epafi::test::Cut;

/// Triangles beside quadrilaterals: each facet keeps its nodes, those between corners between the same ones.
TEST(UnitedSurfaceTest, ATurnedSurfaceHasTheSameFacetsTheOtherWayRound) {
  for (const Cut cut : {Cut::none, Cut::simplices, Cut::mixed})
    for (const int order : {1, 2}) {
      mesh::MeshArrays arrays =
          epafi::test::arraysOf(mesh::StructuredMesh({{0, 0, 0}, {4, 1, 1}}, {4, 1, 1}), {}, cut);
      if (order == 2)
        arrays = completed(std::move(arrays), false);
      const mesh::UnstructuredMesh mesh(arrays);
      const mesh::Surface surface = mesh.surface("top");
      mesh::Surface turned = surface;
      contact::turnOver(turned);
      ASSERT_EQ(turned.facetNodes.size(), surface.facetNodes.size());
      std::vector<Point> points;
      for (std::size_t f = 0; f < surface.numFacets(); ++f) {
        ASSERT_EQ(turned.typeOf(f), surface.typeOf(f));
        mesh.pointsAt(surface.facet(f), points);
        const Eigen::Vector3d area = mesh::areaVector(surface.typeOf(f), points);
        mesh.pointsAt(turned.facet(f), points);
        EXPECT_LT((area + mesh::areaVector(turned.typeOf(f), points)).norm(), 1e-14);
      }
    }
}

/// Of different forms in rows of one length.
TEST(UnitedSurfaceTest, SurfacesOfOneMeshGoTogether) {
  const mesh::UnstructuredMesh mesh(
      epafi::test::arraysOf(mesh::StructuredMesh({{0, 0, 0}, {2, 2, 1}}, {2, 2, 1}), {}, Cut::prisms));
  const std::array<std::string, 2> names{"top", "left"};
  const contact::UnitedSurface both = contact::unite(mesh, names);
  ASSERT_EQ(both.surface.numFacets(), 8U + 2U);
  EXPECT_EQ(both.surface.typeOf(0), mesh::CellType::triangle);
  EXPECT_EQ(both.surface.typeOf(9), mesh::CellType::quadrilateral);
}

} // namespace
} // namespace epafi
