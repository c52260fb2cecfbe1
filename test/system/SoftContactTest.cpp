// Contacts of a stiffness of their own: p = K times the overclosure, C = 1/(K a) beside F.

#include "support/SolidScenes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace epafi {
namespace {

using namespace test;

constexpr double pressedBy = 3, youngOfSoft = 200;

/// Two blocks of height 1 on top of each other, pressed from above; the upper one `across` elements wide, the
/// lower one two, so that mortars join all but two on two. Sides are free, and ν is 0: stress is uniform.
scene::Scene stack(int dimension, int order, int across, double stiffness) {
  scene::Scene scene;
  for (const bool isUpper : {false, true}) {
    const double low = isUpper ? 1 : 0;
    const mesh::Box box =
        dimension == 2 ? mesh::Box{{0, low, 0}, {2, low + 1, 0}} : mesh::Box{{0, 0, low}, {2, 1, low + 1}};
    const int n = isUpper ? across : 2;
    scene.bodies.push_back(block(isUpper ? "upper" : "lower", box,
                                 dimension == 2 ? std::array{n, 2, 0} : std::array{n, 2, 2},
                                 cutInGrid({2, 1, 1})));
    scene.bodies.back().material.youngsModulus = youngOfSoft;
    scene.bodies.back().material.poissonsRatio = 0;
    scene.bodies.back().mesh.order = order;
    scene.bodies.back().supports.push_back(slide("left"));
    if (dimension == 3)
      scene.bodies.back().supports.push_back(slide("front"));
  }
  scene.bodies[0].supports.push_back(slide("bottom"));
  scene.bodies[1].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {}, {pressedBy, 0, 0}}};
  scene.contacts = {between("joint", 1, "bottom", 0, "top")};
  scene.contacts[0].stiffness = stiffness;
  return scene;
}

/// Along the load, of the nodes at a height; to the tolerance of a solution whose largest displacement is
/// that of some body.
void expectMoved(const SolidRun& run, int body, int dimension, double height, double expected) {
  const mesh::Mesh& mesh = *run.decomposition.bodies[body].mesh;
  const Eigen::VectorXd u = run.displacement(body);
  const double tolerance = 1e-8 * std::max(run.displacement(0).lpNorm<Eigen::Infinity>(),
                                           run.displacement(1).lpNorm<Eigen::Infinity>());
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    if (std::abs(mesh.point(node)[static_cast<std::size_t>(dimension - 1)] - height) < 1e-9) {
      EXPECT_NEAR(u[node * dimension + dimension - 1], expected, tolerance);
    }
}

class SoftContactTest : public testing::TestWithParam<std::tuple<int, int, int>> {};

TEST_P(SoftContactTest, GivesWayByPressureOverStiffness) {
  const auto [dimension, order, across] = GetParam();
  for (const double stiffness : {1e-1, 1e2, 1e6}) {
    const SolidRun run(stack(dimension, order, across, stiffness));
    expectMoved(run, 0, dimension, 1, -pressedBy / youngOfSoft);
    expectMoved(run, 1, dimension, 1, -pressedBy / youngOfSoft - pressedBy / stiffness);
    expectMoved(run, 1, dimension, 2, -2 * pressedBy / youngOfSoft - pressedBy / stiffness);
    EXPECT_NEAR(run.solution.contactForce, pressedBy * 2, 1e-7);
    EXPECT_LE(run.solution.algebraicError, 1e-6 * std::sqrt(run.solution.loadWork)) << stiffness;
    // All is linear here: energy is minus half the work, that of the contact too.
    EXPECT_NEAR(run.solution.energy, -0.5 * run.solution.loadWork, 1e-8 * run.solution.loadWork);
  }
}

TEST_P(SoftContactTest, ATieGivesWayInBothSenses) {
  const auto [dimension, order, across] = GetParam();
  for (const double stiffness : {1e-1, 1e2, 1e6})
    for (const double pull : {pressedBy, -pressedBy}) {
      scene::Scene scene = stack(dimension, order, across, stiffness);
      scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
      scene.contacts[0].stickSlope = 0.1 * stiffness;
      scene.bodies[1].supports.clear(); // tangential springs hold it
      scene.bodies[1].loads[0].value[0] = -pull;
      const SolidRun run(scene);
      expectMoved(run, 0, dimension, 1, pull / youngOfSoft);
      expectMoved(run, 1, dimension, 1, pull / youngOfSoft + pull / stiffness);
      expectMoved(run, 1, dimension, 2, 2 * pull / youngOfSoft + pull / stiffness);
      EXPECT_NEAR(run.solution.energy, -0.5 * run.solution.loadWork, 1e-8 * run.solution.loadWork);
    }
}

/// Springs at nodes have the moment of inertia b w³/12 (1 + 2/n²) of the trapezoidal rule.
TEST(SoftContactTiltTest, ABlockTiltsTooLittleByTwoOverNSquaredPlusTwo) {
  for (const int dimension : {2, 3})
    for (const int across : {1, 2, 4}) {
      constexpr double stiffness = 100, press = 8, moment = 2, rigid = 1e9;
      scene::Scene scene = stack(dimension, 1, across, stiffness);
      scene.bodies[0].mesh.elements[0] = across; // meshed alike
      for (scene::Body& body : scene.bodies) {
        body.material.youngsModulus = rigid;
        body.decomposition = cutInGrid({1, 1, 1});
      }
      const std::size_t up = static_cast<std::size_t>(dimension - 1);
      fem::SolidSupport foot{"foot", "bottom", {0.0, 0.0, 0.0}};
      scene.bodies[0].supports = {foot};
      scene.bodies[1].supports = {};
      if (dimension == 3)
        scene.bodies[1].supports.push_back(slide("front"));
      scene.bodies[1].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {}, {press, 0, 0}},
                               {"left", fem::SolidLoad::Kind::traction, {}, "left", {}, {}},
                               {"right", fem::SolidLoad::Kind::traction, {}, "right", {}, {}}};
      scene.bodies[1].loads[1].value[up] = moment / 2; // a couple, at arms of 1
      scene.bodies[1].loads[2].value[up] = -moment / 2;
      scene.contacts[0].friction = 1; // else it slides
      const SolidRun run(scene);
      const mesh::Mesh& mesh = *run.decomposition.bodies[1].mesh;
      const Eigen::VectorXd u = run.displacement(1);
      double atLeft = 0, atRight = 0;
      for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
        if (const double x = mesh.point(node)[0]; x < 1e-9 || x > 2 - 1e-9)
          (x < 1e-9 ? atLeft : atRight) = u[node * dimension + dimension - 1];
      const double exact = moment / (stiffness * 8 / 12), n = across;
      EXPECT_NEAR((atLeft - atRight) / 2, exact * n * n / (n * n + 2), 1e-5 * exact)
          << dimension << ' ' << across;
    }
}

TEST_P(SoftContactTest, OpensWhereItIsPulled) {
  const auto [dimension, order, across] = GetParam();
  scene::Scene scene = stack(dimension, order, across, 50);
  scene.bodies[1].supports.push_back(slide("top", 0.25)); // lifted
  scene.bodies[1].loads.clear();
  const SolidRun run(scene);
  EXPECT_NEAR(run.solution.contactForce, 0, 1e-10);
  expectMoved(run, 1, dimension, 1, 0.25);
}

TEST_P(SoftContactTest, TendsToHardContactAsItStiffens) {
  const auto [dimension, order, across] = GetParam();
  const auto bent = [&](double stiffness) { // pressed at one end alone: it opens at the other
    scene::Scene scene = stack(dimension, order, across, stiffness);
    scene.bodies[1].supports.clear();
    if (dimension == 3)
      scene.bodies[1].supports.push_back(slide("front"));
    scene.bodies[1].supports.push_back(slide("right"));
    scene.bodies[1].loads = {{"press", fem::SolidLoad::Kind::traction, {}, "left", {}, {}}};
    scene.bodies[1].loads[0].value[static_cast<std::size_t>(dimension - 1)] = -1;
    return SolidRun(scene);
  };
  const SolidRun hard = bent(0), stiff = bent(1e9), stiffer = bent(1e11);
  const auto apart = [&](const SolidRun& run) {
    return (run.displacement(1) - hard.displacement(1)).norm() / hard.displacement(1).norm();
  };
  EXPECT_LT(apart(stiff), 1e-4);
  EXPECT_LT(apart(stiffer), 0.05 * apart(stiff) + 1e-8);
}

INSTANTIATE_TEST_SUITE_P(DimensionsOrdersAndMeshes, SoftContactTest,
                         testing::Combine(testing::Values(2, 3), testing::Values(1, 2),
                                          testing::Values(2, 3)));

/// The upper block on a lower one that does not move, pushed along it.
scene::Scene pushed(int dimension, double shear) {
  scene::Scene scene = stack(dimension, 1, 2, 0);
  scene.bodies[1].supports.clear();
  if (dimension == 3)
    scene.bodies[1].supports.push_back(slide("front"));
  scene.bodies[1].supports.push_back(slide("top", -0.01));
  scene.bodies[0].supports.clear();
  scene.bodies[0].supports.push_back({"held", "bottom", {0.0, 0.0, 0.0}});
  scene.bodies[0].supports.push_back({"top", "top", {0.0, 0.0, 0.0}});
  scene.bodies[1].loads = {{"push", fem::SolidLoad::Kind::traction, {}, "right", {}, {shear, 0, 0}}};
  return scene;
}

/// Of the joint, by the trapezoidal rule over its nodes.
double meanShift(const SolidRun& run, int dimension) {
  const mesh::Mesh& mesh = *run.decomposition.bodies[1].mesh;
  const Eigen::VectorXd u = run.displacement(1);
  double shift = 0, weight = 0;
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    if (std::abs(mesh.point(node)[static_cast<std::size_t>(dimension - 1)] - 1) < 1e-9) {
      const bool isEnd = std::abs(mesh.point(node)[0] - 1) > 0.9;
      const bool isSide = dimension == 3 && std::abs(mesh.point(node)[1] - 0.5) > 0.4;
      const double share = (isEnd ? 0.5 : 1.0) * (isSide ? 0.5 : 1.0);
      shift += share * u[node * dimension];
      weight += share;
    }
  return shift / weight;
}

TEST(StickSlopeTest, SticksBySlopeTimesShift) {
  for (const int dimension : {2, 3}) {
    constexpr double slope = 40, shear = 0.5;
    scene::Scene scene = pushed(dimension, shear);
    scene.contacts[0].friction = 0.9;
    scene.contacts[0].stickSlope = slope;
    const SolidRun run(scene);
    // Force on the right face = area of it × shear, borne by the joint's springs: the mean shift follows.
    double force = 0;
    const auto values = run.solution.multiplier->getData();
    const auto slack = run.solution.slack->getData();
    double slip = 0;
    for (const decomposition::FrictionNode& node : run.decomposition.problem.frictionNodes) {
      force += values[node.firstTangent];
      slip = std::max(slip, std::abs(slack[node.firstTangent]));
    }
    force = sumOverRanks(*run.decomposition.problem.comm, force);
    EXPECT_NEAR(std::abs(force), shear * 1, 1e-8);
    EXPECT_LT(maxOverRanks(*run.decomposition.problem.comm, slip), 1e-8) << "it sticks";
    EXPECT_NEAR(meanShift(run, dimension), shear * 1 / (2 * slope), 1e-8);
  }
}

TEST(SoftTieTest, ShearsBySlopeTimesShift) {
  for (const int dimension : {2, 3}) {
    constexpr double slope = 40, shear = 0.5;
    scene::Scene scene = pushed(dimension, shear);
    scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
    scene.contacts[0].stiffness = 500;
    scene.contacts[0].stickSlope = slope;
    EXPECT_NEAR(meanShift(SolidRun(scene), dimension), shear * 1 / (2 * slope), 1e-8);
  }
}

TEST(AdjustTest, GapsUpToItCountAsNone) {
  for (const int across : {2, 3}) {
    scene::Scene scene = stack(2, 1, across, 0);
    scene.bodies[1].mesh.box = {{0, 1.01, 0}, {2, 2.01, 0}};
    scene.contacts[0].adjust = 0.02;
    expectMoved(SolidRun(scene), 1, 2, 2.01, -2 * pressedBy / youngOfSoft);
    scene.contacts[0].adjust = 0.005;
    expectMoved(SolidRun(scene), 1, 2, 2.01, -0.01 - 2 * pressedBy / youngOfSoft);
    scene.bodies[1].mesh.box = {{0, 0.99, 0}, {2, 1.99, 0}}; // overlaps
    expectMoved(SolidRun(scene), 1, 2, 1.99, -2 * pressedBy / youngOfSoft);
  }
}

} // namespace
} // namespace epafi
