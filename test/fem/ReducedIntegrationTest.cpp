/// Elements of 8 and 20 nodes by two points along each axis.

#include "epafi/fem/ElementIntegrals.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include "support/SampleCells.hpp"
#include "support/TurnedMesh.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using namespace test;

constexpr std::array serendipityTypes{mesh::CellType::quadrilateral8, mesh::CellType::hexahedron20};

Eigen::MatrixXd stiffnessOf(mesh::CellType type, std::span<const Point> points, Integration integration) {
  Eigen::MatrixXd stiffness;
  elementStiffness(type, points, elasticPhysics(type).front(), material, stiffness, integration);
  return stiffness;
}

/// With corners moved about, and straight edges.
std::vector<Point> straightCell(mesh::CellType type, std::uint32_t seed) {
  return withAllNodes(type, distortedCell(withOrder(type, 1), seed));
}

/// So that meshes of such elements have constant stresses exactly.
TEST(ReducedIntegrationTest, LinearFieldsHaveTheForcesOfFullIntegrationOnStraightElements) {
  for (const mesh::CellType type : serendipityTypes)
    for (std::uint32_t seed = 10; seed < 20; ++seed) {
      const std::vector<Point> points = straightCell(type, seed);
      Eigen::Matrix3d gradient;
      gradient << 1, 2, -3, 0.5, -1, 4, 2, 1.5, 0.25;
      const Eigen::VectorXd u = linearField(points, dimensionOf(type), gradient),
                            full = stiffnessOf(type, points, Integration::full) * u;
      EXPECT_GT(full.norm(), 1);
      EXPECT_LT((stiffnessOf(type, points, Integration::reduced) * u - full).norm(), 1e-13 * full.norm());
    }
}

TEST(ReducedIntegrationTest, LeavesOneElementMotionsWithoutEnergy) {
  for (const mesh::CellType type : serendipityTypes) {
    const Eigen::VectorXd values =
        direct::eigenOf(stiffnessOf(type, distortedCell(type, 21), Integration::reduced)).values;
    const double largest = values[values.size() - 1];
    const Eigen::Index number = dimensionOf(type) == 2 ? 3 + 1 : 6 + 6;
    EXPECT_LT(values.head(number).cwiseAbs().maxCoeff(), 1e-13 * largest);
    EXPECT_GT(values[number], 1e-3 * largest);
  }
}

/// Number of motions without energy of elements side by side.
Eigen::Index kernelOf(mesh::CellType type, std::array<int, 3> elements, Cut cut = Cut::none, int order = 2) {
  const mesh::StructuredMesh grid({{0, 0, 0}, {1.0 * elements[0], 1.0 * elements[1], 1.0 * elements[2]}},
                                  elements);
  mesh::MeshArrays arrays = arraysOf(grid, {}, cut);
  if (order == 2)
    arrays = completed(std::move(arrays), false, mesh::InnerNodes::none);
  EXPECT_EQ(arrays.cellType, type);
  const int n = dimensionOf(type);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(std::ssize(arrays.points) * n, std::ssize(arrays.points) * n);
  for (LocalOrdinal e = 0; e < arrays.numElements(); ++e) {
    const auto nodes = nodesOf(type, arrays.cells, e);
    std::vector<Point> points;
    for (const LocalOrdinal node : nodes)
      points.push_back(arrays.points[node]);
    const Eigen::MatrixXd stiffness = stiffnessOf(cellOf(type, nodes.size()), points, Integration::reduced);
    for (Eigen::Index a = 0; a < std::ssize(nodes); ++a)
      for (Eigen::Index b = 0; b < std::ssize(nodes); ++b)
        sum.block(n * nodes[a], n * nodes[b], n, n) += stiffness.block(n * a, n * b, n, n);
  }
  const direct::SymmetricEigen spectrum = direct::eigenOf(sum);
  return spectrum.numUpTo(1e-11 * spectrum.values[spectrum.values.size() - 1]);
}

TEST(ReducedIntegrationTest, NeighboursAlongAllAxesButOneLeaveRigidMotionsAlone) {
  EXPECT_EQ(kernelOf(mesh::CellType::quadrilateral8, {2, 1, 0}), 3);
  EXPECT_EQ(kernelOf(mesh::CellType::hexahedron20, {2, 2, 1}), 6);
  EXPECT_EQ(kernelOf(mesh::CellType::hexahedron20, {3, 1, 1}), 6 + 4); // a row: one for each cross-section
}

/// A column of single prisms twists; in pairs, and beside hexahedra and pyramids, they do not.
TEST(ReducedIntegrationTest, PrismsAtEachOthersSidesHaveRigidMotionsAlone) {
  const Eigen::VectorXd one =
      direct::eigenOf(
          stiffnessOf(mesh::CellType::prism, distortedCell(mesh::CellType::prism, 23), Integration::reduced))
          .values;
  EXPECT_LT(one.head(7).cwiseAbs().maxCoeff(), 1e-13 * one[17]);
  EXPECT_GT(one[7], 1e-3 * one[17]);
  EXPECT_EQ(kernelOf(mesh::CellType::prism, {1, 1, 1}, Cut::prisms, 1), 6);
  EXPECT_EQ(kernelOf(mesh::CellType::prism, {2, 1, 3}, Cut::prisms, 1), 6);
  EXPECT_EQ(kernelOf(mesh::CellType::prism15, {1, 1, 1}, Cut::prisms), 6);
  EXPECT_EQ(kernelOf(mesh::CellType::hexahedron, {4, 1, 2}, Cut::mixed, 1), 6);
  EXPECT_EQ(kernelOf(mesh::CellType::hexahedron20, {4, 2, 1}, Cut::mixed), 6);
}

TEST(ReducedIntegrationTest, LoadsKeepTheirResultants) {
  for (const mesh::CellType type : serendipityTypes) {
    const std::vector<Point> points = straightCell(type, 22);
    const int components = dimensionOf(type);
    Eigen::VectorXd full, reduced;
    bodyForceLoad(type, points, elasticPhysics(type).front(), material, {1, 2, 3}, full);
    bodyForceLoad(type, points, elasticPhysics(type).front(), material, {1, 2, 3}, reduced,
                  Integration::reduced);
    EXPECT_LT((resultant(full, components) - resultant(reduced, components)).norm(), 1e-13);
    for (const auto& facet : facetsOf(type)) {
      const auto corners = facetPoints(type, points, facet);
      pressureLoad(facet.type, corners, elasticPhysics(type).front(), material, 3, full);
      pressureLoad(facet.type, corners, elasticPhysics(type).front(), material, 3, reduced,
                   Integration::reduced);
      EXPECT_LT((full - reduced).norm(), 1e-13);
    }
  }
}

} // namespace
} // namespace epafi::fem
