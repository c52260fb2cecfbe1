#include "epafi/fem/ElementIntegrals.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace epafi::fem {
namespace {

using namespace test;

int componentsIn(mesh::CellType type, Physics physics) {
  return physics == Physics::membrane ? 1 : dimensionOf(type);
}

Eigen::MatrixXd stiffnessOf(mesh::CellType type, std::span<const Point> points, Physics physics,
                            const Material& of = material) {
  Eigen::MatrixXd stiffness;
  elementStiffness(type, points, physics, of, stiffness);
  return stiffness;
}

Eigen::VectorXd bodyLoadOf(mesh::CellType type, std::span<const Point> points, Physics physics,
                           const Vector3& force) {
  Eigen::VectorXd load;
  bodyForceLoad(type, points, physics, material, force, load);
  return load;
}

/// action(type, points, physics) for distorted elements of all types and all physics that go with them.
template <class Action>
void onDistortedElements(const Action& action) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : allPhysics(type))
      for (std::uint32_t seed = 10; seed < 20; ++seed) {
        SCOPED_TRACE(testing::Message()
                     << toString(type) << ", physics " << static_cast<int>(physics) << ", seed " << seed);
        action(type, distortedCell(type, seed), physics);
      }
}

/// Translations and infinitesimal rotations, a column each; the constant of a membrane.
Eigen::MatrixXd rigidModes(mesh::CellType type, std::span<const Point> points, Physics physics) {
  const int components = componentsIn(type, physics);
  const auto rows = static_cast<Eigen::Index>(points.size()) * components;
  const int turns = components == 1 ? 0 : components == 2 ? 1 : 3;
  Eigen::MatrixXd modes(rows, components + turns);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Eigen::Vector3d x = vectorOf(points[row / components]);
    for (int i = 0; i < components; ++i)
      modes(row, i) = row % components == i ? 1 : 0;
    for (int axis = 3 - turns; axis < 3; ++axis)
      modes(row, components + axis - (3 - turns)) = Eigen::Vector3d::Unit(axis).cross(x)[row % components];
  }
  return modes;
}

TEST(ElementStiffnessTest, IsSymmetricToTheLastBitAndTheSameAgain) {
  onDistortedElements([](mesh::CellType type, const std::vector<Point>& points, Physics physics) {
    const Eigen::MatrixXd stiffness = stiffnessOf(type, points, physics);
    ASSERT_EQ(stiffness.rows(), numNodesOf(type) * componentsIn(type, physics));
    EXPECT_EQ(stiffness, stiffness.transpose());
    EXPECT_EQ(stiffness, stiffnessOf(type, points, physics));
  });
}

TEST(ElementStiffnessTest, IsSemidefiniteAndItsKernelAreTheRigidModes) {
  onDistortedElements([](mesh::CellType type, const std::vector<Point>& points, Physics physics) {
    const Eigen::MatrixXd stiffness = stiffnessOf(type, points, physics);
    const Eigen::MatrixXd modes = rigidModes(type, points, physics);
    EXPECT_LT((stiffness * modes).norm(), 1e-13 * stiffness.norm());
    const Eigen::VectorXd values = direct::eigenOf(stiffness).values;
    const auto kernel = modes.cols();
    const double largest = values[values.size() - 1];
    EXPECT_LT(values.head(kernel).cwiseAbs().maxCoeff(), 1e-14 * largest);
    EXPECT_GT(values[kernel], 1e-3 * largest);
  });
}

TEST(ElementStiffnessTest, TurnsWithTheElement) {
  onDistortedElements([](mesh::CellType type, const std::vector<Point>& points, Physics physics) {
    const int components = componentsIn(type, physics), size = numNodesOf(type) * components;
    const Eigen::Matrix3d turn = rotation(type, 0.7);
    const auto turned = mapped(points, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return turn * x; });
    Eigen::MatrixXd turnAll = Eigen::MatrixXd::Zero(size, size);
    for (int a = 0; a < size; a += components)
      if (components == 1)
        turnAll(a, a) = 1;
      else
        turnAll.block(a, a, components, components) = turn.topLeftCorner(components, components);
    const Eigen::MatrixXd expected = turnAll * stiffnessOf(type, points, physics) * turnAll.transpose();
    EXPECT_LT((stiffnessOf(type, turned, physics) - expected).norm(), 1e-13 * expected.norm());
  });
}

TEST(ElementStiffnessTest, DoesNotKnowWhereTheElementIs) {
  onDistortedElements([](mesh::CellType type, const std::vector<Point>& points, Physics physics) {
    // Multiples of 2⁻²⁰ can be moved by 2²⁰ without rounding.
    const auto rounded = mapped(points, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return (x * 0x1p20).array().round() * 0x1p-20;
    });
    const auto far = mapped(rounded, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return x + Eigen::Vector3d(0x1p20, -0x1p20, 0x1p19);
    });
    EXPECT_EQ(stiffnessOf(type, far, physics), stiffnessOf(type, rounded, physics));
  });
}

/// K ~ modulus · length^(dimension − 2) · thickness in the plane.
TEST(ElementStiffnessTest, FollowsTheUnits) {
  onDistortedElements([](mesh::CellType type, const std::vector<Point>& points, Physics physics) {
    const double length = 1e3, modulus = 1e6, thickness = physics == Physics::membrane ? 1 : 20;
    Material other = material;
    other.conductivity *= modulus;
    other.youngsModulus *= modulus;
    if (dimensionOf(type) == 2)
      other.thickness *= 20;
    const auto larger =
        mapped(points, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return length * x; });
    const double factor = modulus * (dimensionOf(type) == 3 ? length : thickness);
    const Eigen::MatrixXd expected = factor * stiffnessOf(type, points, physics);
    EXPECT_LT((stiffnessOf(type, larger, physics, other) - expected).norm(), 1e-13 * expected.norm());
  });
}

/// ∫∇N_i·∇N_j over a rectangle in closed form; each row: node with itself, its x-neighbour, the opposite
/// node, its y-neighbour.
Eigen::Matrix4d rectangleStiffness(double hx, double hy) {
  const double a = hy / (6 * hx), b = hx / (6 * hy);
  const double self = 2 * a + 2 * b, alongX = -2 * a + b, opposite = -a - b, alongY = a - 2 * b;
  Eigen::Matrix4d k;
  k << self, alongX, opposite, alongY, //
      alongX, self, alongY, opposite,  //
      opposite, alongY, self, alongX,  //
      alongY, opposite, alongX, self;
  return k;
}

TEST(ElementStiffnessTest, OfRectangularMembranesIsThatInClosedForm) {
  for (const auto& [hx, hy] : {std::array{1.0, 1.0}, std::array{0.5, 2.0}, std::array{1e-3, 3e-3}}) {
    const std::vector<Point> rectangle{{7, 1, 0}, {7 + hx, 1, 0}, {7 + hx, 1 + hy, 0}, {7, 1 + hy, 0}};
    const double width = rectangle[1][0] - 7, height = rectangle[2][1] - 1; // as rounded
    const Eigen::Matrix4d expected = 3 * rectangleStiffness(width, height);
    EXPECT_LT((stiffnessOf(mesh::CellType::quadrilateral, rectangle, Physics::membrane) - expected)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-14 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(ElementStiffnessTest, OfTheUnitTriangleIsTheTextbooksOne) {
  Eigen::Matrix3d membrane; // κ = 3
  membrane << 3, -1.5, -1.5, -1.5, 1.5, 0, -1.5, 0, 1.5;
  const auto triangle = unitCell(mesh::CellType::triangle);
  EXPECT_LT((stiffnessOf(mesh::CellType::triangle, triangle, Physics::membrane) - membrane).norm(), 1e-14);
  // Plane strain, E = 10, ν = ¼: λ = μ = 4; area and thickness ½ each.
  Eigen::MatrixXd plane(6, 6);
  plane << 4, 2, -3, -1, -1, -1, //
      2, 4, -1, -1, -1, -3,      //
      -3, -1, 3, 0, 0, 1,        //
      -1, -1, 0, 1, 1, 0,        //
      -1, -1, 0, 1, 1, 0,        //
      -1, -3, 1, 0, 0, 3;
  EXPECT_LT((stiffnessOf(mesh::CellType::triangle, triangle, Physics::planeStrain) - plane).norm(), 1e-14);
}

/// A layer of hexahedra as thick as the quadrilateral, moved as it and not across, has the same energy.
TEST(ElementStiffnessTest, OfPlaneStrainIsThatOfALayerWithoutStrainAcross) {
  for (std::uint32_t seed = 30; seed < 35; ++seed) {
    const auto base = distortedCell(mesh::CellType::quadrilateral, seed);
    auto layer = base;
    for (const Point& point : base)
      layer.push_back({point[0], point[1], material.thickness});
    Eigen::MatrixXd across =
        Eigen::MatrixXd::Zero(24, 8); // displacements of the layer from those of the plane
    for (int node = 0; node < 8; ++node)
      for (int i = 0; i < 2; ++i)
        across(3 * node + i, 2 * (node % 4) + i) = 1;
    const Eigen::MatrixXd inThePlane = stiffnessOf(mesh::CellType::quadrilateral, base, Physics::planeStrain);
    const Eigen::MatrixXd ofTheLayer =
        across.transpose() * stiffnessOf(mesh::CellType::hexahedron, layer, Physics::elasticity3d) * across;
    EXPECT_LT((inThePlane - ofTheLayer).norm(), 1e-13 * inThePlane.norm());
  }
}

/// Plane stress is the layer whose displacement across is free: −ν/(1 − ν)(ε_xx + ε_yy) z in a linear field.
TEST(ElementStiffnessTest, OfPlaneStressHasTheEnergyOfALayerFreeAcross) {
  const auto base = distortedCell(mesh::CellType::quadrilateral, 36);
  auto layer = base;
  for (const Point& point : base)
    layer.push_back({point[0], point[1], material.thickness});
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient.topLeftCorner<2, 2>() << 1, 2, -0.5, 4;
  const Eigen::VectorXd plane = linearField(base, 2, gradient);
  gradient(2, 2) = -(1.0 / 3) * (gradient(0, 0) + gradient(1, 1)); // ν = ¼
  const Eigen::VectorXd solid = linearField(layer, 3, gradient);
  const double planeEnergy =
      plane.dot(stiffnessOf(mesh::CellType::quadrilateral, base, Physics::planeStress) * plane);
  const double solidEnergy =
      solid.dot(stiffnessOf(mesh::CellType::hexahedron, layer, Physics::elasticity3d) * solid);
  EXPECT_NEAR(planeEnergy, solidEnergy, 1e-13 * solidEnergy);
}

TEST(BodyForceLoadTest, SumsToForceTimesMeasure) {
  onDistortedElements([](mesh::CellType type, const std::vector<Point>& points, Physics physics) {
    const Vector3 force{1, -2, 4};
    const int components = componentsIn(type, physics);
    const Eigen::VectorXd load = bodyLoadOf(type, points, physics, force);
    ASSERT_EQ(load.size(), numNodesOf(type) * components);
    const double thickness =
        components == 2 ? material.thickness : 1; // neither membranes nor solids have one
    const Eigen::Vector3d sum = resultant(load, components);
    for (int i = 0; i < components; ++i)
      EXPECT_NEAR(sum[i], thickness * measureOf(type, points) * force[i], 1e-14);
  });
}

/// First moments of a trapezium (sides 3 and 1, height 1; centroid at height 5/12) and of a frustum of a
/// pyramid.
TEST(BodyForceLoadTest, ActsAtTheCentroid) {
  const std::vector<Point> trapezium{{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  const Eigen::VectorXd plane =
      bodyLoadOf(mesh::CellType::quadrilateral, trapezium, Physics::membrane, {6, 0, 0});
  EXPECT_NEAR(3 * plane[1] + 2 * plane[2] + plane[3], 12 * 1.5, 1e-14);
  EXPECT_NEAR(plane[2] + plane[3], 12 * 5.0 / 12, 1e-14);
  const std::vector<Point> frustum{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0},
                                   {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  const Eigen::VectorXd solid =
      bodyLoadOf(mesh::CellType::hexahedron, frustum, Physics::elasticity3d, {1, 0, 0});
  // Sides 4 − 2z: ∫(4 − 2z)² = 28/3, ∫z(4 − 2z)² = 11/3.
  EXPECT_NEAR(solid.sum(), 28.0 / 3, 1e-14);
  EXPECT_NEAR(solid[12] + solid[15] + solid[18] + solid[21], 11.0 / 3, 1e-14);
}

} // namespace
} // namespace epafi::fem
