// Sliding planes of symmetry: half and quarter of a model have the solution of the whole.

#include "support/SolidScenes.hpp"

#include "epafi/mesh/Mesh.hpp"

#include <array>
#include <cmath>
#include <map>

namespace epafi {
namespace {

using namespace test;

/// A narrow block on a wide one, pressed down in its middle, so that its rim lifts; its top cannot move
/// sideways. Symmetric to x = 0 and, in space, to y = 0.
/// \param half  the directions in which half of it is left out, behind a sliding plane
scene::Scene pressedInTheMiddle(int dimension, std::array<bool, 2> half) {
  const bool isSpace = dimension == 3;
  const std::size_t up = dimension - 1;
  scene::Scene scene;
  for (int level = 0; level < 2; ++level) {
    const int cells = level == 0 ? (isSpace ? 8 : 24) : (isSpace ? 6 : 16);
    const double width = level == 0 ? (isSpace ? 4.0 / 3 : 1.5) : 1;
    mesh::Box box{{0, 0, 0}, {0, 0, 0}};
    std::array<int, 3> elements{0, 0, 0};
    for (std::size_t d = 0; d < up; ++d) {
      box.lower[d] = half[d] ? 0 : -width / 2;
      box.upper[d] = width / 2;
      elements[d] = half[d] ? cells / 2 : cells;
    }
    box.lower[up] = level == 0 ? -0.5 : 0;
    box.upper[up] = level == 0 ? 0 : 0.25;
    elements[up] = isSpace ? 2 : 4;
    scene.bodies.push_back(block(level == 0 ? "lower" : "upper", box, elements, cutByMetis(6)));
    scene::Body& solid = scene.bodies.back();
    fem::SolidSupport held{"held sideways", level == 0 ? "bottom" : "top", {0.0, std::nullopt, std::nullopt}};
    if (isSpace)
      held.value[1] = 0.0;
    if (level == 0)
      held.value[up] = 0.0;
    solid.supports = {held};
    for (std::size_t d = 0; d < up; ++d)
      if (half[d])
        solid.supports.push_back(slide(d == 0 ? "left" : "front"));
  }
  fem::SolidLoad press = weight({0, 0, 0});
  press.value[up] = -20;
  for (std::size_t d = 0; d < up; ++d) {
    press.box.lower[d] = -0.2;
    press.box.upper[d] = 0.2;
  }
  scene.bodies[1].loads = {press};
  scene.contacts = {between("joint", 1, "bottom", 0, "top")};
  return scene;
}

/// Places of points whatever their round-off.
std::array<long, 3> keyOf(const Point& x) {
  return {std::lround(1e6 * x[0]), std::lround(1e6 * x[1]), std::lround(1e6 * x[2])};
}

/// Values at the nodes of a body by place.
template <class Value>
std::map<std::array<long, 3>, Value> byPlace(const mesh::Mesh& mesh, const std::vector<GlobalOrdinal>& nodes,
                                             const std::vector<Value>& values) {
  std::map<std::array<long, 3>, Value> result;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    result[keyOf(mesh.point(nodes[k]))] = values[k];
  return result;
}

const mesh::Mesh& meshOfBody(const SolidRun& run, int body) {
  return *run.decomposition.bodies[body].mesh;
}

std::map<std::array<long, 3>, Eigen::VectorXd> displacements(const SolidRun& run, int body) {
  const mesh::Mesh& mesh = meshOfBody(run, body);
  const Eigen::VectorXd u = run.displacement(body);
  const int n = run.decomposition.problem.components;
  std::vector<GlobalOrdinal> nodes;
  std::vector<Eigen::VectorXd> values;
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
    nodes.push_back(node);
    values.emplace_back(u.segment(node * n, n));
  }
  return byPlace(mesh, nodes, values);
}

std::map<std::array<long, 3>, double> forces(const SolidRun& run) {
  return byPlace(meshOfBody(run, 1), run.decomposition.contacts[0].firstNodes, run.forces());
}

void expectPartOf(const SolidRun& part, const SolidRun& whole, std::array<bool, 2> half) {
  const double share = (half[0] ? 0.5 : 1) * (half[1] ? 0.5 : 1);
  ASSERT_EQ(part.solver.report().status, qp::Status::converged) << part.solver.report().reason;
  EXPECT_NEAR(part.solution.energy, share * whole.solution.energy, 1e-9 * std::abs(whole.solution.energy));
  EXPECT_NEAR(part.solution.contactForce, share * whole.solution.contactForce,
              1e-9 * whole.solution.contactForce);
  for (int body = 0; body < 2; ++body) {
    const auto all = displacements(whole, body);
    const double size = whole.displacement(body).lpNorm<Eigen::Infinity>();
    for (const auto& [place, u] : displacements(part, body))
      EXPECT_LE((u - all.at(place)).lpNorm<Eigen::Infinity>(), 1e-9 * size);
  }
  const auto all = forces(whole);
  for (const auto& [place, force] : forces(part)) {
    const double own = (half[0] && place[0] == 0 ? 0.5 : 1) * (half[1] && place[1] == 0 ? 0.5 : 1);
    EXPECT_NEAR(force, own * all.at(place), 1e-9 * whole.solution.contactForce);
  }
}

TEST(SymmetryTest, HalfAndQuarterOfAModelHaveTheSolutionOfTheWhole) {
  for (const int dimension : {2, 3}) {
    const SolidRun whole(pressedInTheMiddle(dimension, {false, false}), 1e-12);
    ASSERT_EQ(whole.solver.report().status, qp::Status::converged) << whole.solver.report().reason;
    EXPECT_EQ(whole.decomposition.problem.kernelDimension, dimension); // down, and about the axes of its top
    EXPECT_GT(whole.solution.activeContactNodes, 4);
    EXPECT_LT(whole.solution.activeContactNodes, whole.decomposition.problem.numInequalities - 1);
    std::vector<std::array<bool, 2>> parts{{true, false}};
    if (dimension == 3)
      parts.insert(parts.end(), {{false, true}, {true, true}});
    for (const std::array<bool, 2> half : parts) {
      SCOPED_TRACE(testing::Message() << dimension << half[0] << half[1]);
      const SolidRun part(pressedInTheMiddle(dimension, half), 1e-12);
      EXPECT_EQ(part.decomposition.problem.kernelDimension,
                dimension - (half[0] ? 1 : 0) - (half[1] ? 1 : 0));
      expectPartOf(part, whole, half);
    }
  }
}

} // namespace
} // namespace epafi
