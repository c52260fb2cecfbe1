#include "epafi/fem/DistributedTraction.hpp"

#include "epafi/mesh/UnstructuredMesh.hpp"

#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using namespace test;

mesh::UnstructuredMesh oneElement(mesh::CellType type) {
  mesh::MeshArrays arrays;
  arrays.name = "The element";
  arrays.cellType = type;
  arrays.points = distortedCell(type, 5);
  for (LocalOrdinal node = 0; node < std::ssize(arrays.points); ++node) {
    arrays.cells.push_back(node);
    arrays.nodeTags.push_back(node + 1);
  }
  arrays.elementTags = {1};
  return mesh::UnstructuredMesh(std::move(arrays));
}

/// Sums of the forces at nodes, and of their moments about a point.
std::pair<Eigen::Vector3d, Eigen::Vector3d> sumsOf(const SolidBody& body, const mesh::Surface& surface,
                                                   const SolidLoad& load, const Eigen::Vector3d& about) {
  const auto materialAt = [&](std::size_t) -> const Material& { return body.solid.material; };
  const DistributedTraction traction(body, surface, load, materialAt);
  std::pair<Eigen::Vector3d, Eigen::Vector3d> sums{{0, 0, 0}, {0, 0, 0}};
  std::vector<Point> points;
  Eigen::VectorXd values;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    body.mesh.pointsAt(surface.facet(f), points);
    traction.of(surface.typeOf(f), points, body.solid.material, values);
    for (std::size_t a = 0; a < points.size(); ++a) {
      Eigen::Vector3d force(0, 0, 0);
      force.head(body.components()) =
          values.segment(static_cast<Eigen::Index>(a) * body.components(), body.components());
      sums.first += force;
      sums.second += (vectorOf(points[a]) - about).cross(force);
    }
  }
  return sums;
}

/// On facets of every type, straight or curved, all of an element or one alone.
TEST(DistributedTractionTest, HasTheForceAndTheMomentToRoundOff) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      SCOPED_TRACE(mesh::toString(type));
      const mesh::UnstructuredMesh mesh = oneElement(type);
      Solid solid;
      solid.physics = physics;
      solid.material = material;
      const bool isPlane = dimensionOf(type) == 2;
      SolidLoad load{"remote", SolidLoad::Kind::distributed, {},
                     "",       {5, -3, isPlane ? 0.0 : 2.0}, {7, -2, isPlane ? 0.0 : 3.0}};
      load.moment = {isPlane ? 0.0 : 4.0, isPlane ? 0.0 : -6.0, 5};
      load.atCentre = false;
      const mesh::Surface all = mesh.boundary();
      mesh::Surface one{all.facetType, {}, {0}};
      one.add(all.facet(0));
      for (const mesh::Surface* const surface : std::vector<const mesh::Surface*>{&all, &one}) {
        const auto [force, moment] =
            sumsOf(SolidBody(solid, mesh), *surface, load, Eigen::Vector3d(load.point.data()));
        EXPECT_LT((force - Eigen::Vector3d(load.value.data())).norm(), 1e-13);
        EXPECT_LT((moment - Eigen::Vector3d(load.moment.data())).norm(), 1e-12);
      }
    }
}

TEST(DistributedTractionTest, AtTheCentreIsEvenIfThereIsNoMoment) {
  const mesh::UnstructuredMesh mesh = oneElement(mesh::CellType::hexahedron);
  Solid solid;
  solid.physics = Physics::elasticity3d;
  solid.material = material;
  const SolidBody body(solid, mesh);
  mesh::Surface face{mesh.boundary().facetType, {}, {0}};
  face.add(mesh.boundary().facet(0));
  const auto materialAt = [&](std::size_t) -> const Material& { return solid.material; };
  const SolidLoad load{"push", SolidLoad::Kind::distributed, {}, "", {}, {1, 2, 3}};
  std::vector<Point> points;
  mesh.pointsAt(face.facet(0), points);
  double area = 0;
  for (const FacetSample& sample : facetSamples(face.typeOf(0), points, solid.physics, solid.material))
    area += sample.weight;
  Eigen::VectorXd linear, even;
  DistributedTraction(body, face, load, materialAt).of(face.typeOf(0), points, solid.material, linear);
  tractionLoad(face.typeOf(0), points, solid.physics, solid.material, {1 / area, 2 / area, 3 / area}, even);
  EXPECT_LT((linear - even).norm(), 1e-13);
}

} // namespace
} // namespace epafi::fem
