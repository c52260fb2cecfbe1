// Two elastic blocks, one on the other: the number of products with F hardly depends on how many subdomains
// there are, nor on their shape, and the answer not at all.

#include "support/SolidScenes.hpp"

#include <algorithm>
#include <cmath>

namespace epafi {
namespace {

using scene::Decomposition;

/// How the upper block is loaded: its lid pressed down, so that all contact closes, or half of the block
/// lifted.
enum class Load { pressed, halfLifted };

/// \param cuts  1/H; METIS makes as many parts as a grid would. \param elements  H/h
scene::Scene twoBlocks(int dimension, Load load, Decomposition::Method method, int cuts, int elements) {
  const std::size_t up = dimension - 1;
  scene::Scene scene;
  Decomposition cut;
  cut.method = method;
  cut.counts = {cuts, cuts, dimension == 3 ? cuts : 1};
  cut.parts = dimension == 3 ? cuts * cuts * cuts : cuts * cuts;
  const int n = cuts * elements;
  for (int level = 0; level < 2; ++level) {
    const double low = level, high = 1.0 + level;
    scene.bodies.push_back(
        dimension == 3
            ? test::block(level == 0 ? "lower" : "upper", {{0, 0, low}, {1, 1, high}}, {n, n, n}, cut)
            : test::block(level == 0 ? "lower" : "upper", {{0, low, 0}, {1, high, 0}}, {n, n, 0}, cut));
  }
  fem::SolidSupport floor{"floor", "bottom", {0.0, 0.0, std::nullopt}},
      lid{"lid", "top", {0.0, 0.0, std::nullopt}};
  if (dimension == 3)
    floor.value[2] = lid.value[2] = 0.0;
  lid.value[up] = -0.01;
  scene.bodies[0].supports = {floor};
  scene.bodies[1].supports = {lid};
  fem::SolidLoad weight;
  weight.name = "weight";
  weight.value[up] = -1;
  weight.box.upper[0] = 0.5;
  fem::SolidLoad lift = weight;
  lift.name = "lift";
  lift.value[up] = 8;
  lift.box = mesh::Box{};
  lift.box.lower[0] = 0.5;
  scene.bodies[1].loads = {weight};
  if (load == Load::halfLifted)
    scene.bodies[1].loads.push_back(lift);
  scene.contacts = {test::between("joint", 0, "top", 1, "bottom")};
  return scene;
}

struct Solved {
  int products = 0;
  double energy = 0, projectedGradient = 0;
};

Solved solve(const scene::Scene& scene, double tolerance) {
  const test::SolidRun run(scene, tolerance);
  EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
  return {run.solver.report().counts.hessianMultiplications, run.solution.energy,
          run.solution.relativeProjectedGradient};
}

int products(int dimension, Load load, Decomposition::Method method, int cuts, int elements) {
  const Solved solved = solve(twoBlocks(dimension, load, method, cuts, elements), 1e-6);
  EXPECT_LE(solved.projectedGradient, 1e-6);
  return solved.products;
}

constexpr auto grid = Decomposition::Method::grid, metis = Decomposition::Method::metis;

TEST(ScalabilityTest, InThePlaneAClosedContactTakesHardlyMoreProductsWithMoreSubdomains) {
  const int two = products(2, Load::pressed, grid, 2, 8), eight = products(2, Load::pressed, grid, 8, 8);
  EXPECT_LE(two, 11); // 8 was measured
  EXPECT_LT(eight, 1.5 * two);
  EXPECT_LE(products(2, Load::pressed, grid, 16, 8), eight + 3);
}

/// What grows is the search for the contact zone, and it settles.
TEST(ScalabilityTest, InThePlaneAHalfOpenContactSettles) {
  const int four = products(2, Load::halfLifted, grid, 4, 8),
            sixteen = products(2, Load::halfLifted, grid, 16, 8);
  EXPECT_LE(four, 14);    // 11 was measured, 20 without averages
  EXPECT_LE(sixteen, 18); // 13 to 16 with round-off; 34 without averages
}

TEST(ScalabilityTest, InSpaceProductsGrowLittle) {
  for (const Load load : {Load::pressed, Load::halfLifted}) {
    const int two = products(3, load, grid, 2, 4);
    EXPECT_LE(two, 24); // 20 was measured; 36 with chained rows of gluing
    EXPECT_LT(products(3, load, grid, 3, 4), 1.5 * two);
    EXPECT_LT(products(3, load, grid, 4, 4), 1.5 * two);
  }
}

TEST(ScalabilityTest, MetisPartsCostLittleMoreThanGridParts) {
  for (const Load load : {Load::pressed, Load::halfLifted}) {
    for (const int cuts : {2, 4, 8})
      EXPECT_LT(products(2, load, metis, cuts, 8), 1.6 * products(2, load, grid, cuts, 8)) << cuts;
    for (const int cuts : {2, 3})
      EXPECT_LT(products(3, load, metis, cuts, 4), 1.6 * products(3, load, grid, cuts, 4)) << cuts;
  }
}

/// Factorisations fail where a part is loose.
TEST(ScalabilityTest, AnyNumberOfMetisPartsIsRegularAndGivesTheSameEnergy) {
  for (const int dimension : {2, 3}) {
    const int elements = dimension == 2 ? 16 : 6;
    scene::Scene scene = twoBlocks(dimension, Load::halfLifted, grid, 1, elements);
    const double energy = solve(scene, 1e-10).energy;
    for (const int parts : {2, 3, 4, 5, 8, 11, 16, 23, 32}) {
      for (scene::Body& body : scene.bodies)
        body.decomposition = test::cutByMetis(parts);
      EXPECT_NEAR(solve(scene, 1e-10).energy, energy, 1e-9 * std::abs(energy)) << dimension << ' ' << parts;
    }
    EXPECT_NEAR(solve(twoBlocks(dimension, Load::halfLifted, grid, 2, elements / 2), 1e-10).energy, energy,
                1e-9 * std::abs(energy));
  }
}

} // namespace
} // namespace epafi
