/// Solids of revolution: one rigid motion, exact states of constant stress, volumes and areas of the whole
/// circumference, and what lies on the axis.

#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FluxIntegrals.hpp"

#include "WholeBody.hpp"
#include "support/Refusal.hpp"
#include "support/SampleCells.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace epafi::fem {
namespace {

using namespace test;
using mesh::CellType;

constexpr double pi = std::numbers::pi;
constexpr std::array revolvedCells{CellType::triangle, CellType::quadrilateral, CellType::triangle6,
                                   CellType::quadrilateral9, CellType::quadrilateral8};

/// Any form with straight edges, away from the axis by `x`; middle nodes in the middle.
std::vector<Point> cellAt(CellType type, double x, std::uint32_t seed) {
  return mapped(withAllNodes(type, distortedCell(withOrder(type, 1), seed)),
                [&](const Eigen::Vector3d& at) { return at + Eigen::Vector3d(x, 0, 0); });
}

/// One edge of the unit cell on the axis.
std::vector<Point> cellOnAxis(CellType type) {
  return withAllNodes(type, unitCell(withOrder(type, 1)));
}

/// u = (a x, b y + 1).
Eigen::VectorXd stretched(std::span<const Point> points, double a, double b) {
  Eigen::VectorXd u(2 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    u.segment<2>(2 * static_cast<Eigen::Index>(i)) = Eigen::Vector2d(a * points[i][0], b * points[i][1] + 1);
  return u;
}

double volumeOf(CellType type, std::span<const Point> points) {
  Eigen::VectorXd load;
  bodyForceLoad(type, points, Physics::axisymmetric, test::material, {0, 1, 0}, load);
  return resultant(load, 2)[1];
}

TEST(AxisymmetricTest, AMotionAlongTheAxisAloneCostsNoEnergy) {
  for (const CellType type : revolvedCells)
    for (const auto& points : {cellOnAxis(type), cellAt(type, 0.3, 1), cellAt(type, 50, 2)}) {
      Eigen::MatrixXd stiffness;
      elementStiffness(type, points, Physics::axisymmetric, test::material, stiffness);
      EXPECT_EQ(stiffness, stiffness.transpose());
      const direct::SymmetricEigen eigen = direct::eigenOf(stiffness);
      EXPECT_GT(eigen.values[0], -1e-12 * eigen.values.maxCoeff());
      EXPECT_EQ(eigen.numUpTo(1e-9 * eigen.values.maxCoeff()), 1) << toString(type) << points[0][0];
      Eigen::VectorXd along = Eigen::VectorXd::Zero(stiffness.rows());
      for (Eigen::Index i = 1; i < along.size(); i += 2)
        along[i] = 1;
      EXPECT_LT((stiffness * along).norm(), 1e-12 * eigen.values.maxCoeff());
    }
}

TEST(AxisymmetricTest, ConstantStressIsMetAndBalancesTheTractionsOnAllEdges) {
  const double a = 0.02, b = -0.03, modulus = test::material.youngsModulus,
               ratio = test::material.poissonsRatio;
  const double factor = modulus / ((1 + ratio) * (1 - 2 * ratio)), across = factor * (a + ratio * b),
               along = factor * ((1 - ratio) * b + 2 * ratio * a);
  for (const CellType type : revolvedCells)
    for (const auto& points : {cellOnAxis(type), cellAt(type, 0.3, 3), cellAt(type, 5, 4)}) {
      const Eigen::VectorXd u = stretched(points, a, b);
      Eigen::MatrixXd stiffness, sampled;
      sampledFluxes(type, points, Physics::axisymmetric, test::material, spanOf(u), sampled);
      for (const auto& stress : sampled.colwise())
        EXPECT_LT((stress - Eigen::Vector<double, 6>(across, along, across, 0, 0, 0)).norm(), 1e-12);
      elementStiffness(type, points, Physics::axisymmetric, test::material, stiffness);
      Eigen::VectorXd forces = Eigen::VectorXd::Zero(u.size()), load;
      for (const mesh::Facet& facet : facetsOf(type)) {
        const std::vector<Point> edge = facetPoints(type, points, facet);
        const Eigen::Vector3d normal = mesh::areaVector(facetTypeOf(type), edge).normalized();
        tractionLoad(facetTypeOf(type), edge, Physics::axisymmetric, test::material,
                     {across * normal[0], along * normal[1], 0}, load);
        addFacetLoad(type, facet, load, forces);
      }
      EXPECT_LT((stiffness * u - forces).norm(), 1e-12 * forces.norm()) << toString(type);
      Eigen::MatrixXd none = sampled.col(0).replicate(1, static_cast<Eigen::Index>(points.size()));
      const FluxEnergies energies =
          fluxEnergies(type, points, Physics::axisymmetric, test::material, spanOf(u), none);
      EXPECT_NEAR(energies.flux, u.dot(stiffness * u), 1e-11 * energies.flux);
      EXPECT_LT(energies.difference, 1e-24);
    }
}

TEST(AxisymmetricTest, LoadsAreThoseOfTheWholeCircumference) {
  for (const CellType type : revolvedCells) {
    // A ring of the square (2, 3) × (0, 1), or of its half.
    const auto points =
        mapped(unitCell(type), [](const Eigen::Vector3d& x) { return Eigen::Vector3d(x[0] + 2, x[1], 0); });
    const bool isHalf = numCornersOf(type) == 3;
    const double volume = isHalf ? pi * (2 + 1.0 / 3) : 5 * pi;
    EXPECT_NEAR(volumeOf(type, points), volume, 1e-12 * volume);
    Eigen::VectorXd load;
    SolidLoad turn{"turn", SolidLoad::Kind::rotation, {}, "", {0, 0, 0}, {3, 0, 0}, true, {0, 1, 0}};
    rotationLoad(type, points, Physics::axisymmetric, test::material, turn, load);
    // 3 ∫ 2πr² over the triangle: r from 2 to 3, 3 − r high
    const double radial = isHalf ? 6 * pi * (19.0 - 65.0 / 4) : 38 * pi;
    EXPECT_NEAR(resultant(load, 2)[0], radial, 1e-12 * radial);
    EXPECT_EQ(resultant(load, 2)[1], 0);
    const mesh::Facet bottom = facetsOf(type)[0];
    const std::vector<Point> edge = facetPoints(type, points, bottom);
    pressureLoad(facetTypeOf(type), edge, Physics::axisymmetric, test::material, 2, load);
    EXPECT_NEAR(resultant(load, 2)[1], 2 * 5 * pi, 1e-12);
    const std::function<FieldValue(const Point&)> nothing;
    const Eigen::VectorXd u = stretched(points, 0, 0);
    EXPECT_NEAR(
        differenceNorms(type, points, Physics::axisymmetric, test::material, spanOf(u), nothing).square,
        volume, 1e-12 * volume);
  }
}

Solid cylinder() {
  Solid solid;
  solid.name = "cylinder";
  solid.physics = Physics::axisymmetric;
  return solid;
}

TEST(AxisymmetricTest, NodesOnTheAxisStayThereIfTheBodyHoldsThem) {
  Solid solid = cylinder();
  const mesh::StructuredMesh mesh(mesh::rectangle(0, 2, -1, 1), {3, 2, 0}, 2);
  const BodyModel free(solid, mesh);
  EXPECT_EQ(free.kernelDimension(), 1);
  const AssembledSubdomain whole = assembled(free);
  EXPECT_LT((whole.stiffness * whole.kernel).norm(), 1e-12 * Eigen::MatrixXd(whole.stiffness).norm());
  EXPECT_EQ(direct::eigenOf(whole.stiffness).numUpTo(1e-9), 1);
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
    EXPECT_EQ(free.prescribed(node, 0).has_value(), mesh.point(node)[0] == 0);
    EXPECT_FALSE(free.prescribed(node, 1).has_value());
  }
  solid.supports = {{"floor", "bottom", {std::nullopt, 0.0, std::nullopt}},
                    {"axis", "left", {0.0, std::nullopt, std::nullopt}}};
  EXPECT_EQ(BodyModel(solid, mesh).kernelDimension(), 0);
  solid.holdsAxis = false;
  solid.supports.pop_back();
  EXPECT_FALSE(BodyModel(solid, mesh).prescribed(0, 0).has_value());
  EXPECT_EQ(direct::eigenOf(assembled(BodyModel(solid, mesh)).stiffness).numUpTo(1e-9), 0)
      << "integration does not ask the axis";
  solid.holdsAxis = true;
  solid.supports.push_back({"axis", "left", {0.5, std::nullopt, std::nullopt}});
  expectSays(refusal([&] { const BodyModel model(solid, mesh); }),
             {"and 'axis of revolution'", "in component x", "0.5 and 0"});
}

TEST(AxisymmetricTest, RefusesNegativeRadiiAndMeshesInSpace) {
  const Solid solid = cylinder();
  expectSays(refusal([&] {
               const mesh::StructuredMesh mesh(mesh::rectangle(-1, 2, 0, 1), {3, 2, 0});
               const BodyModel model(solid, mesh);
             }),
             {"body 'cylinder'", "x = -1", "x >= 0"});
  expectSays(refusal([&] {
               const mesh::StructuredMesh mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
               const BodyModel model(solid, mesh);
             }),
             {"its physics is axisymmetric"});
}

} // namespace
} // namespace epafi::fem
