// Surfaces that slide along themselves, in any direction, and the rigid motions that supports leave.

#include "WholeBody.hpp"
#include "support/MeshFiles.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/SupportNormals.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace epafi::fem {
namespace {

using test::arraysOf;
using test::expectRefusal;
using test::placed;
using Value = std::optional<double>;

const Value none;

SolidSupport slide(const std::string& surface, double normal = 0) {
  return {"slide " + surface, surface, {none, none, none}, normal};
}

std::unique_ptr<mesh::Mesh> structured(int dimension) {
  if (dimension == 3)
    return std::make_unique<mesh::StructuredMesh>(mesh::Box{{0, 0, 0}, {2, 1, 1.5}},
                                                  std::array<int, 3>{3, 2, 2});
  return std::make_unique<mesh::StructuredMesh>(mesh::rectangle(0, 2, 0, 1), std::array<int, 3>{4, 3, 0});
}

mesh::UnstructuredMesh turned(int dimension, double angle, bool simplices, double shift = 17) {
  const Eigen::Vector3d far(shift, -shift / 2, dimension == 3 ? 3 : 0);
  return mesh::UnstructuredMesh(arraysOf(*structured(dimension), placed(dimension, angle, far), simplices));
}

Solid solidWith(int dimension, std::vector<SolidSupport> supports) {
  Solid solid;
  solid.name = "block";
  solid.physics = dimension == 3 ? Physics::elasticity3d : Physics::planeStrain;
  solid.supports = std::move(supports);
  return solid;
}

/// The kernel that geometry tells must be the kernel of the matrix: K R = 0, and no further eigenvalue
/// vanishes.
void expectKernelOfMatrix(const BodyModel& model) {
  const AssembledSubdomain whole = assembled(model);
  ASSERT_EQ(whole.kernel.cols(), model.kernelDimension());
  EXPECT_LE((whole.stiffness * whole.kernel).norm(), 1e-11 * whole.stiffness.norm());
  EXPECT_EQ(Eigen::MatrixXd(whole.stiffness), Eigen::MatrixXd(whole.stiffness.transpose()));
  const direct::SymmetricEigen eigen = direct::eigenOf(whole.stiffness);
  EXPECT_EQ(eigen.numUpTo(1e-10 * eigen.values.maxCoeff()), model.kernelDimension());
}

TEST(SolidSupportsTest, NormalsOfAxisParallelPlanesAreComponents) {
  for (const int dimension : {2, 3}) {
    const auto mesh = structured(dimension);
    SolidSupport left{"left", "left", {-0.25, none, none}}, bottom{"bottom", "bottom", {}};
    bottom.value[dimension - 1] = 0.5;
    const Solid byComponents = solidWith(dimension, {left, bottom}),
                byNormals = solidWith(dimension, {slide("left", 0.25), slide("bottom", -0.5)});
    const BodyModel a(byComponents, *mesh), b(byNormals, *mesh);
    EXPECT_FALSE(b.hasFrames());
    const AssembledSubdomain x = assembled(a), y = assembled(b);
    EXPECT_EQ(x.unknownOf, y.unknownOf);
    EXPECT_EQ(x.data.prescribed, y.data.prescribed);
    EXPECT_EQ(Eigen::MatrixXd(x.stiffness), Eigen::MatrixXd(y.stiffness));
    EXPECT_EQ(x.data.rightHandSide(), y.data.rightHandSide());
  }
}

TEST(SolidSupportsTest, ComponentsInTurnedAxesAreThoseOfTheTurnedBody) {
  const double angle = 0.7;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const mesh::UnstructuredMesh mesh = turned(2, angle, false);
  SolidSupport left{"left", "left", {-0.25, none, none}};
  left.axes = LocalAxes{false, {turn(0, 0), turn(1, 0), 0}, {turn(0, 1), turn(1, 1), 0}};
  const Solid byAxes = solidWith(2, {left}), byNormals = solidWith(2, {slide("left", 0.25)});
  const BodyModel a(byAxes, mesh), b(byNormals, mesh);
  EXPECT_EQ(a.kernelDimension(), b.kernelDimension());
  const AssembledSubdomain x = assembled(a), y = assembled(b);
  EXPECT_EQ(x.unknownOf, y.unknownOf);
  EXPECT_LE((Eigen::MatrixXd(x.stiffness).cwiseAbs() - Eigen::MatrixXd(y.stiffness).cwiseAbs()).norm(),
            1e-12 * y.stiffness.norm()); // axes may point the other way
}

TEST(SolidSupportsTest, CylindricalAxesLeadAwayFromTheLine) {
  const LocalAxes axes{true, {1, 0, 0}, {1, 0, 5}};
  const Eigen::Matrix3d at = axesAt(axes, {1, 3, 7});
  EXPECT_LE((at.col(0) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_LE((at.col(1) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-15);
  EXPECT_LE((at.col(2) - Eigen::Vector3d(0, 0, 1)).norm(), 1e-15);
  // A ring held around its axis and along it cannot move but grow: no rigid motion is left.
  const auto mesh = structured(3);
  SolidSupport around{"around", "left", {none, 0, 0}};
  around.axes = LocalAxes{true, {-3, 0.5, 0}, {-3, 0.5, 1}};
  const Solid solid = solidWith(3, {around});
  const BodyModel model(solid, *mesh);
  EXPECT_TRUE(model.hasFrames());
  EXPECT_EQ(model.kernelDimension(), 0);
  expectKernelOfMatrix(model);
}

TEST(SolidSupportsTest, TurnedSlidingPlanesLeaveAsManyMotionsAsStraightOnes) {
  const std::vector<std::pair<std::vector<SolidSupport>, int>> plane{
      {{slide("left")}, 1}, {{slide("left"), slide("right")}, 1}, {{slide("left"), slide("bottom")}, 0}},
      space{{{slide("left")}, 3},
            {{slide("left"), slide("bottom")}, 1},
            {{slide("left"), slide("right"), slide("bottom")}, 1},
            {{slide("left"), slide("bottom"), slide("front")}, 0}};
  for (const int dimension : {2, 3})
    for (const bool simplices : {false, true})
      for (const auto& [supports, numModes] : dimension == 2 ? plane : space) {
        const Solid solid = solidWith(dimension, supports);
        const mesh::UnstructuredMesh mesh = turned(dimension, 0.7, simplices);
        const BodyModel model(solid, mesh);
        EXPECT_TRUE(model.hasFrames());
        EXPECT_EQ(model.kernelDimension(), numModes);
        expectKernelOfMatrix(model);
      }
}

/// u of all unknowns, prescribed ones included, turned back into space.
Eigen::VectorXd inSpace(const BodyModel& model, const AssembledSubdomain& whole, const Eigen::VectorXd& u) {
  Eigen::VectorXd all = whole.data.prescribed;
  for (std::size_t i = 0; i < whole.unknownPosition.size(); ++i)
    all[whole.unknownPosition[i]] = u[i];
  const int n = model.components();
  for (std::size_t node = 0; node < whole.nodes.size(); ++node)
    if (const Eigen::Matrix3d* frame = model.frame(whole.nodes[node])) {
      auto own = all.segment(static_cast<Eigen::Index>(node) * n, n);
      own = (frame->topLeftCorner(n, n) * own).eval();
    }
  return all;
}

TEST(SolidSupportsTest, AStretchBetweenSlidingPlanesTurnsWithTheBody) {
  for (const int dimension : {2, 3})
    for (const bool simplices : {false, true}) {
      std::vector<SolidSupport> supports{slide("left", 0.0), slide("right", 0.3), slide("bottom", 0.0)};
      if (dimension == 3)
        supports.push_back(slide("front"));
      const Solid solid = solidWith(dimension, supports);
      const test::Placement placement = placed(dimension, 0.7, {11, -5, dimension == 3 ? 3.0 : 0.0});
      const auto straightMesh = structured(dimension);
      const mesh::UnstructuredMesh mesh(arraysOf(*straightMesh, placement, simplices)),
          original(arraysOf(*straightMesh, {}, simplices));
      const BodyModel model(solid, mesh), straight(solid, original);
      const auto solution = [](const BodyModel& m) {
        const AssembledSubdomain whole = assembled(m);
        return inSpace(m, whole, direct::solvedSymmetric(whole.stiffness, whole.data.rightHandSide()));
      };
      const Eigen::VectorXd u = solution(model), v = solution(straight);
      EXPECT_NEAR(v[dimension == 2 ? 8 : 9], 0.3, 1e-12); // x = 2: the straight one is stretched at all
      for (Eigen::Index node = 0; node < u.size() / dimension; ++node)
        EXPECT_LE(
            (u.segment(dimension * node, dimension) -
             placement.turn.topLeftCorner(dimension, dimension) * v.segment(dimension * node, dimension))
                .norm(),
            1e-11);
      EXPECT_NEAR(assembled(model).data.energyOffset(), assembled(straight).data.energyOffset(), 1e-10);
    }
}

TEST(SolidSupportsTest, LoadsAndEnergyTurnWithTheFrames) {
  using Kind = SolidLoad::Kind;
  for (const int dimension : {2, 3}) {
    Solid framed = solidWith(dimension, {slide("left")}), plain = solidWith(dimension, {});
    framed.loads = {{"press", Kind::pressure, {}, "left", {}, {7, 0, 0}},
                    {"weight", Kind::body, {}, "", {}, {1, 2, dimension == 3 ? 3.0 : 0.0}}};
    plain.loads = framed.loads;
    const mesh::UnstructuredMesh mesh = turned(dimension, 1.1, false);
    const BodyModel a(framed, mesh), b(plain, mesh);
    for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
      Eigen::MatrixXd k, reference;
      Eigen::VectorXd f, expected;
      a.element(element, k, f);
      b.element(element, reference, expected);
      std::vector<GlobalOrdinal> nodes(mesh.nodesPerElement());
      mesh.elementNodes(element, nodes);
      Eigen::MatrixXd q = Eigen::MatrixXd::Identity(k.rows(), k.cols());
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (const Eigen::Matrix3d* frame = a.frame(nodes[i])) {
          EXPECT_LE((*frame * frame->transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
          q.block(static_cast<Eigen::Index>(i) * dimension, static_cast<Eigen::Index>(i) * dimension,
                  dimension, dimension) = frame->topLeftCorner(dimension, dimension);
        }
      EXPECT_LE((q * k * q.transpose() - reference).norm(), 1e-13 * reference.norm());
      EXPECT_LE((q * f - expected).norm(), 1e-13 * (1 + expected.norm()));
    }
  }
}

TEST(SolidSupportsTest, RandomSupportsLeaveTheKernelOfTheMatrix) {
  std::mt19937 random(20);
  const std::vector<std::string> plane{"left", "right", "bottom", "top"},
      space{"left", "right", "bottom", "top", "front", "back"};
  const auto draw = [&](int below) { return std::uniform_int_distribution<int>(0, below - 1)(random); };
  std::array<int, 7> seen{};
  for (int trial = 0; trial < 60; ++trial) {
    const int dimension = 2 + trial % 2;
    const std::vector<std::string>& names = dimension == 2 ? plane : space;
    std::vector<SolidSupport> supports;
    for (int s = draw(4); s > 0; --s) {
      SolidSupport support{
          "support " + std::to_string(s), names[draw(static_cast<int>(names.size()))], {none, none, none}};
      if (draw(3) > 0)
        support.normal = 0.0;
      else
        support.value[draw(dimension)] = 0.0;
      supports.push_back(support);
    }
    const Solid solid = solidWith(dimension, supports);
    const mesh::UnstructuredMesh mesh = turned(dimension, trial % 4 < 2 ? 0.0 : 0.1 * trial, trial % 3 == 0);
    const BodyModel model(solid, mesh);
    SCOPED_TRACE(trial);
    expectKernelOfMatrix(model);
    ++seen[model.kernelDimension()];
  }
  for (const std::size_t dimension : {0U, 1U, 3U, 6U})
    EXPECT_GT(seen[dimension], 0) << dimension;
}

TEST(SolidSupportsTest, NormalsAndComponentsMeetInANode) {
  const double s = std::sqrt(0.5);
  const mesh::UnstructuredMesh mesh = turned(2, std::atan(1.0), false, 0); // left: outward (−s, −s)
  const Solid solid =
      solidWith(2, {{"pull", "left", {1.0, none, none}}, slide("left", 0.0)}); // held altogether: (1, −1)
  const BodyModel model(solid, mesh);
  EXPECT_FALSE(model.hasFrames());
  const mesh::Surface left = mesh.surface("left");
  EXPECT_NEAR(*model.prescribed(left.facetNodes[0], 0), 1.0, 1e-14);
  EXPECT_NEAR(*model.prescribed(left.facetNodes[0], 1), -1.0, 1e-14);
  EXPECT_NEAR(supportNormals(mesh, left)[0].normal.dot(Eigen::Vector3d(-s, -s, 0)), 1.0, 1e-14);
}

TEST(SolidSupportsTest, ContradictionsAreRefused) {
  const mesh::UnstructuredMesh mesh = turned(3, 0.4, false);
  const auto refused = [&](std::vector<SolidSupport> supports, const std::vector<std::string>& words) {
    const Solid solid = solidWith(3, std::move(supports));
    expectRefusal([&] { BodyModel(solid, mesh); }, words);
  };
  SolidSupport held{"glue", "left", {0.0, 0.0, 0.0}};
  refused({held, slide("left", 0.1)}, {"'block'", "'slide left'", "different values"});
  refused({slide("left", 0.0), slide("left", 0.2)}, {"different values"});
  refused({held, {"twist", "bottom", {0.0, 0.5, 0.0}}}, {"component y", "different values"});
  const Solid agreeing = solidWith(3, {held, slide("left", 0.0), slide("bottom", 0.0), slide("front", 0.0)});
  EXPECT_NO_THROW(BodyModel(agreeing, mesh));

  Solid membrane = solidWith(2, {slide("left")});
  membrane.physics = Physics::membrane;
  const auto flat = structured(2);
  expectRefusal([&] { BodyModel(membrane, *flat); }, {"'block'", "membrane", "normal"});
}

/// A ring of quadrilaterals, its outer edge "rim"; spacing of the spokes: `angle(i)`.
template <class Angle>
mesh::UnstructuredMesh ring(int spokes, const Angle& angle) {
  mesh::MeshArrays arrays;
  arrays.cellType = mesh::CellType::quadrilateral;
  arrays.surfaces = {{"rim", {}}};
  for (const double radius : {1.0, 2.0})
    for (int i = 0; i < spokes; ++i)
      arrays.points.push_back({3 + radius * std::cos(angle(i)), radius * std::sin(angle(i)), 0});
  for (int i = 0; i < spokes; ++i) {
    const int next = (i + 1) % spokes;
    arrays.cells.insert(arrays.cells.end(), {i, spokes + i, spokes + next, next});
    arrays.surfaces[0].nodes.insert(arrays.surfaces[0].nodes.end(), {spokes + i, spokes + next});
  }
  for (GlobalOrdinal n = 1; n <= 2 * spokes; ++n)
    arrays.nodeTags.push_back(n);
  for (GlobalOrdinal e = 1; e <= spokes; ++e)
    arrays.elementTags.push_back(e);
  return mesh::UnstructuredMesh(arrays);
}

TEST(SolidSupportsTest, ARimThatSlidesAlongItselfLeavesTheTurnWhereItsNormalsDo) {
  const Solid solid = solidWith(2, {slide("rim")});
  const mesh::UnstructuredMesh even = ring(24, [](int i) { return i * M_PI / 12; });
  for (const NodeNormal& at : supportNormals(even, even.surface("rim"))) {
    const Point x = even.point(at.node); // the mean of two chords' normals is the circle's
    EXPECT_LE((2 * at.normal - Eigen::Vector3d(x[0] - 3, x[1], 0)).norm(), 1e-14);
  }
  const BodyModel turns(solid, even);
  EXPECT_EQ(turns.kernelDimension(), 1);
  expectKernelOfMatrix(turns);
  // Uneven chords: their mean normals are no radii, and hold the turn; K says so too.
  const mesh::UnstructuredMesh uneven = ring(24, [](int i) { return (i + 0.3 * (i % 3)) * M_PI / 12; });
  const BodyModel holds(solid, uneven);
  EXPECT_EQ(holds.kernelDimension(), 0);
  expectKernelOfMatrix(holds);
}

TEST(SolidSupportsTest, AnEdgeOfASurfaceHoldsAlongBothNormals) {
  const mesh::UnstructuredMesh square = ring(4, [](int i) { return i * M_PI / 2; });
  const auto normals = supportNormals(square, square.surface("rim"));
  EXPECT_EQ(normals.size(), 8U);
  const Solid solid = solidWith(2, {slide("rim")});
  const BodyModel model(solid, square);
  EXPECT_EQ(model.kernelDimension(), 0);
  EXPECT_FALSE(model.hasFrames());
}

/// Points moved at random by up to `size`.
mesh::UnstructuredMesh disturbed(mesh::MeshArrays arrays, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-size, size);
  for (Point& point : arrays.points)
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimensionOf(arrays.cellType)); ++d)
      point[d] += move(random);
  return mesh::UnstructuredMesh(std::move(arrays));
}

TEST(SolidSupportsTest, TinyChangesOfTheGeometryKeepTheMotionsOfSlidingPlanes) {
  for (const int dimension : {2, 3})
    for (const double size : {1e-12, 1e-9, 1e-7}) {
      const mesh::MeshArrays arrays =
          arraysOf(*structured(dimension), placed(dimension, 0.7, {11, -5, 0}), true);
      const mesh::UnstructuredMesh mesh = disturbed(arrays, size, 5);
      const Solid solid = solidWith(dimension, {slide("left")});
      const BodyModel model(solid, mesh);
      EXPECT_EQ(model.kernelDimension(), dimension == 2 ? 1 : 3) << size;
      const AssembledSubdomain whole = assembled(model);
      EXPECT_LE((whole.stiffness * whole.kernel).norm(), 1e-12 * whole.stiffness.norm()) << size;
    }
}

TEST(SolidSupportsTest, ABodyThatIsHardlyHeldIsRefused) {
  // A long strip slides on two planes at its ends that meet at an angle of 1e-7 only: too little to hold its
  // height.
  mesh::MeshArrays arrays = arraysOf(*structured(2), {}, false);
  for (Point& point : arrays.points)
    if (point[0] == 2)
      point[0] += 1e-7 * 3 * point[1];
  const mesh::UnstructuredMesh mesh(arrays);
  const Solid solid = solidWith(2, {slide("left"), slide("right")});
  expectRefusal([&] { BodyModel(solid, mesh); }, {"'block'", "hardly hold"});
}

} // namespace
} // namespace epafi::fem
