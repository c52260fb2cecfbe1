// Solids of revolution with closed forms: a tube under pressure, a turning shaft, a ring shrunk onto a shaft,
// and what a body does that nothing holds along its axis.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/accuracy/ErrorNorms.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace epafi {
namespace {

using namespace test;
using mesh::CellType;

constexpr double modulus = 200, ratio = 0.3, lameLambda = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio)),
                 lameMu = modulus / (2 * (1 + ratio));

/// A displacement u_r(r) without strain along the axis, its derivative beside it.
struct Radial {
  std::function<std::array<double, 2>(double)> u;

  [[nodiscard]] fem::FieldValue at(const Point& point) const {
    const double r = point[0];
    const auto [value, slope] = u(r);
    const double around = value / r, trace = lameLambda * (slope + around);
    return {{value, 0, 0}, {trace + 2 * lameMu * slope, trace, trace + 2 * lameMu * around, 0, 0, 0}};
  }
};

/// Lamé's tube of the radii 1 and 2 under the inner pressure 3.
Radial tube() {
  const double a = 3.0 / (3 * 2 * (lameLambda + lameMu)), b = 4 * 3.0 / (3 * 2 * lameMu);
  return {[=](double r) { return std::array{a * r + b / r, a - b / (r * r)}; }};
}

/// A shaft of the radius 1 with the force 5r per volume, u = Cr − Dr³.
Radial shaft() {
  const double d = 5 / (8 * (lameLambda + 2 * lameMu)),
               c = d * (3 * (lameLambda + 2 * lameMu) + lameLambda) / (2 * lameLambda + 2 * lameMu);
  return {[=](double r) { return std::array{c * r - d * r * r * r, c - 3 * d * r * r}; }};
}

/// A slice of the height 1/2 between sliding floors, n elements across.
scene::Scene slice(double inner, double outer, CellType cell, int order, int n,
                   const epafi::test::MeshFolder& folder) {
  scene::Body body = block("body", mesh::rectangle(inner, outer, 0, 0.5), {n, n / 2, 0}, cutByMetis(4));
  body.physics = Physics::axisymmetric;
  body.mesh.order = order;
  if (cell == CellType::triangle) {
    const mesh::StructuredMesh square(body.mesh.box, body.mesh.elements);
    body.mesh = {};
    body.mesh.file = folder.write("slice" + std::to_string(n) + ".msh",
                                  epafi::test::fileOf(epafi::test::arraysOf(square, {}, true)));
    body.mesh.group = "body";
    body.mesh.order = order;
  }
  body.supports = {slide("bottom"), slide("top")};
  scene::Scene scene;
  scene.bodies = {body};
  return scene;
}

class RevolutionTest : public testing::TestWithParam<std::tuple<CellType, int>> {};

TEST_P(RevolutionTest, ErrorsFallWithTheOrderAndTheEstimateKnowsThem) {
  const auto [cell, order] = GetParam();
  using Kind = fem::SolidLoad::Kind;
  for (const bool turns : {false, true}) {
    const Radial exact = turns ? shaft() : tube();
    const epafi::test::MeshFolder folder;
    std::vector<accuracy::ErrorNorms> errors;
    for (const int n : {6, 12}) {
      scene::Scene scene = slice(turns ? 0 : 1, turns ? 1 : 2, cell, order, n, folder);
      if (turns)
        scene.bodies[0].loads = {{"turn", Kind::rotation, {}, "", {0, 0, 0}, {5, 0, 0}, true, {0, 1, 0}}};
      else
        scene.bodies[0].loads = {{"inside", Kind::pressure, {}, "left", {0, 0, 0}, {3, 0, 0}}};
      const SolidRun run(scene, 1e-11);
      errors.push_back(accuracy::errorNorms(scene, run.decomposition, run.solution.displacement,
                                            [&](int, const Point& point) { return exact.at(point); }));
      const double estimate =
          accuracy::ErrorEstimator(scene, run.decomposition)(run.solution.displacement).discretisation;
      // Of order 2 it is a rough one: along lines of a mesh fluxes of triangles are continuous, and wrong.
      EXPECT_GT(estimate, (order == 1                   ? 0.5
                           : cell == CellType::triangle ? 0.1
                                                        : 0.25) *
                              errors.back().energy)
          << n << turns;
      EXPECT_LT(estimate, 3 * errors.back().energy) << n << turns;
    }
    EXPECT_GT(std::log2(errors[0].energy / errors[1].energy), order - 0.15) << turns;
    EXPECT_GT(std::log2(errors[0].l2 / errors[1].l2), order + 1 - 0.2) << turns;
  }
}

std::string nameOfSlice(const testing::TestParamInfo<std::tuple<CellType, int>>& instance) {
  return mesh::toString(std::get<0>(instance.param)) + std::to_string(std::get<1>(instance.param));
}

INSTANTIATE_TEST_SUITE_P(Slices, RevolutionTest,
                         testing::Combine(testing::Values(CellType::triangle, CellType::quadrilateral),
                                          testing::Values(1, 2)),
                         nameOfSlice);

/// p = E δ (c² − b²)/(2 b c²) of one material, free along the axis, b = 1, c = 2: the shaft is compressed
/// evenly, u_r = −(1 − ν) p r/E, and the sides meet at its edge.
TEST(ShrinkFitTest, PressureIsThatOfTheClosedForm) {
  constexpr double interference = 0.01, fit = modulus * interference * 3 / 8, height = 0.5;
  for (const bool byMortar : {false, true}) {
    scene::Scene scene;
    scene.bodies = {
        block("shaft", mesh::rectangle(0, 1, 0, height), {4, 4, 0}, cutByMetis(3)),
        block("ring", mesh::rectangle(1, 2, 0, height), {12, byMortar ? 5 : 4, 0}, cutByMetis(3))};
    for (scene::Body& body : scene.bodies) {
      body.physics = Physics::axisymmetric;
      body.mesh.order = 2;
      body.supports = {slide("bottom")};
    }
    scene.contacts = {between("fit", 0, "right", 1, "left")};
    scene.contacts[0].gap = -interference;
    const SolidRun run(scene, 1e-11);
    EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
    EXPECT_NEAR(run.solution.contactForce, fit * 2 * std::numbers::pi * height, 5e-4 * fit) << byMortar;
    const contact::ContactLayout& rows = run.decomposition.contacts[0];
    EXPECT_EQ(!rows.firstShares.empty(), byMortar);
    const std::vector<double> forces = run.forces();
    for (std::size_t row = 0; row < forces.size(); ++row)
      EXPECT_NEAR(forces[row] / rows.areas[row], fit, 2e-3 * fit) << row << byMortar;
    const Eigen::VectorXd u = run.displacement(0);
    const mesh::Mesh& mesh = *run.decomposition.bodies[0].mesh;
    for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
      EXPECT_NEAR(u[2 * node], -(1 - ratio) * fit / modulus * mesh.point(node)[0], 1e-4 * interference);
  }
}

/// Two cylinders of the height 1 with springs between them: the upper end sinks by p/K + 2p/E everywhere.
TEST(SoftRevolutionTest, SpringsActByTheAreasThatTheirNodesMakeAllAround) {
  constexpr double pressure = 3, stiffness = 10;
  for (const bool byMortar : {false, true}) {
    scene::Scene scene;
    scene.bodies = {block("lower", mesh::rectangle(0, 1, 0, 1), {byMortar ? 5 : 4, 3, 0}, cutByMetis(3)),
                    block("upper", mesh::rectangle(0, 1, 1, 2), {4, 3, 0}, cutByMetis(3))};
    for (scene::Body& body : scene.bodies) {
      body.physics = Physics::axisymmetric;
      body.mesh.order = 2;
    }
    scene.bodies[0].supports = {slide("bottom")};
    scene.bodies[1].loads = {
        {"press", fem::SolidLoad::Kind::pressure, {}, "top", {0, 0, 0}, {pressure, 0, 0}}};
    scene.contacts = {between("joint", 0, "top", 1, "bottom")};
    scene.contacts[0].stiffness = stiffness;
    const SolidRun run(scene);
    EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
    EXPECT_NEAR(run.solution.contactForce, pressure * std::numbers::pi, 1e-7);
    const Eigen::VectorXd u = run.displacement(1);
    const mesh::Mesh& mesh = *run.decomposition.bodies[1].mesh;
    for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
      EXPECT_NEAR(u[2 * node + 1], -pressure / stiffness - pressure / modulus * mesh.point(node)[1], 1e-7)
          << byMortar;
  }
}

/// A shaft that floats, pressed onto a sphere, away from it, or where nothing is.
TEST(FloatingRevolutionTest, ABodyMovesAlongItsAxisAlone) {
  for (const int cluster : {0, 1}) {
    scene::Scene scene;
    scene.bodies = {block("shaft", mesh::rectangle(0, 1, 0, 2), {4, 8, 0}, cutInGrid({2, 4, 1}))};
    scene.bodies[0].physics = Physics::axisymmetric;
    scene.bodies[0].decomposition.cluster = cluster;
    scene.bodies[0].loads = {weight({0, -1, 0})};
    scene::SurfaceContact sphere = onPlane("ball", 0, "bottom", {0, -3, 0}, {0, 1, 0});
    sphere.obstacle.kind = scene::Obstacle::Kind::sphere;
    sphere.obstacle.radius = 3;
    scene.contacts = {sphere};
    const SolidRun run(scene);
    EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
    EXPECT_EQ(run.decomposition.problem.bodies[0].kernelDimension, 1);
    const std::vector<double> forces = run.forces();
    double along = 0;
    for (std::size_t row = 0; row < forces.size(); ++row)
      along -= forces[row] * run.decomposition.contacts[0].directionAt(row)[1];
    EXPECT_NEAR(along, 2 * std::numbers::pi, 1e-7) << "the weight of the cylinder";
    scene.bodies[0].loads = {weight({0, 1, 0})};
    expectNoSolution(scene, {"slide along y"});
    scene.contacts.clear();
    expectNoSolution(scene, {"slide along y"});
  }
}

} // namespace
} // namespace epafi
