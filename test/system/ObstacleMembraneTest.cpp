// Membranes over and under rigid obstacles: closed forms of strips, and gaps along z.

#include "support/WholeRun.hpp"

#include "epafi/base/Errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using namespace epafi;

constexpr double width = 0.25;

/// The unit strip held at its left and right, under an even load.
scene::Scene strip(int elements, int order, double load, const scene::Obstacle& obstacle) {
  scene::Scene scene;
  scene::Body body;
  body.name = "strip";
  body.mesh.box = mesh::rectangle(0, 1, 0, width);
  body.mesh.elements = {elements, 2, 0};
  body.mesh.order = order;
  body.supports = {{"left", "left", {0.0}}, {"right", "right", {0.0}}};
  body.loads = {fem::loadInside("weight", body.mesh.box, load)};
  scene.bodies = {body};
  scene::SurfaceContact contact;
  contact.name = "rest";
  contact.obstacle = obstacle;
  scene.contacts = {contact};
  return scene;
}

/// Largest |u − exact(x)| at nodes.
template <class Exact>
double largestError(const simulation::SceneRun& run, const Exact& exact) {
  const Eigen::VectorXd u = test::deflection(run, 0);
  const mesh::Mesh& mesh = *run.decomposition->bodies[0].mesh;
  double largest = 0;
  for (Eigen::Index node = 0; node < u.size(); ++node)
    largest = std::max(largest, std::abs(u[node] - exact(mesh.point(node)[0])));
  return largest;
}

// u'' = q outside of the contact, which begins at a = √(2g/q) = 1/4, a node: nodal values are exact.
TEST(ObstacleMembraneTest, AStripPressedOntoAPlaneIsAParabolaBesideIt) {
  constexpr double g = 1.0 / 16, q = 2, a = 0.25;
  for (const double side : {-1.0, 1.0}) // below, above
    for (const int order : {1, 2})
      for (const bool isGrid : {true, false}) {
        SCOPED_TRACE(std::to_string(side) + ", order " + std::to_string(order));
        const scene::Scene scene =
            strip(16, order, side * q, {scene::Obstacle::Kind::plane, {7, 3, side * g}, {0, 0, -side}});
        const simulation::SceneRun run =
            test::solve(isGrid ? test::cutInGrid(scene, 2) : test::cutByMetis(scene, 3), 1e-12);
        EXPECT_LE(largestError(run,
                               [&](double x) {
                                 const double beside = std::max(0.0, a - std::min(x, 1 - x));
                                 return side * (g - 0.5 * q * beside * beside);
                               }),
                  1e-9);
        const simulation::ContactResult& contact = run.result.contacts.at(0);
        EXPECT_NEAR(contact.resultant[2], -side * q * (1 - 2 * a) * width, 1e-9);
        EXPECT_NEAR(contact.area, (1 - 2 * a) * width, width / 8);
      }
}

// Without a load a strip lies on a roller across it along the arc between its tangents through the supports.
TEST(ObstacleMembraneTest, AStripOverARollerFollowsItsArc) {
  constexpr double radius = 1, top = 0.1;
  const auto arc = [&](double x) {
    return top - radius + std::sqrt(radius * radius - (x - 0.5) * (x - 0.5));
  };
  const auto slope = [&](double x) { return (0.5 - x) / std::sqrt(radius * radius - (x - 0.5) * (x - 0.5)); };
  double low = 0, high = 0.5; // of b with arc(b) = b slope(b)
  for (int i = 0; i < 60; ++i) {
    const double b = 0.5 * (low + high);
    (arc(b) < b * slope(b) ? low : high) = b;
  }
  const double b = low;
  const scene::Obstacle roller{scene::Obstacle::Kind::cylinder, {0.5, 0, top - radius}, {0, 1, 0}, radius};
  for (const int order : {1, 2}) {
    double last = 0;
    for (const int elements : {16, 32, 64}) {
      SCOPED_TRACE(std::to_string(elements) + ", order " + std::to_string(order));
      const simulation::SceneRun run =
          test::solve(test::cutByMetis(strip(elements, order, 0, roller), 2), 1e-12);
      const double error = largestError(run, [&](double x) {
        const double near = std::min(x, 1 - x);
        return near < b ? near * slope(b) : arc(x);
      });
      EXPECT_LE(error, 0.4 / (elements * elements)) << last;
      EXPECT_NEAR(run.result.contacts.at(0).resultant[2], 2 * slope(b) * width, 1.0 / elements * width);
      last = error;
    }
  }
}

// Gaps are distances along z; what a line along z misses has no row.
TEST(ObstacleMembraneTest, ABallStopsTheNodesOverItAlongZ) {
  const scene::Obstacle ball{scene::Obstacle::Kind::sphere, {0.5, 0.1, -0.5}, {0, 0, 1}, 0.3};
  const simulation::SceneRun run = test::solve(test::cutByMetis(strip(16, 1, -4, ball), 2), 1e-12);
  const contact::ContactLayout& layout = run.decomposition->contacts.at(0);
  const mesh::Mesh& mesh = *run.decomposition->bodies[0].mesh;
  GlobalOrdinal over = 0;
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    over += std::hypot(mesh.point(node)[0] - 0.5, mesh.point(node)[1] - 0.1) < 0.3 ? 1 : 0;
  EXPECT_EQ(layout.numRows(), over);
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row) {
    const Point x = mesh.point(layout.firstNodes[row]);
    const Eigen::Vector3d reached(x[0] - 0.5, x[1] - 0.1, 0.5 - layout.gaps[row]);
    EXPECT_NEAR(reached.norm(), 0.3, 1e-12);
    EXPECT_GT(reached[2], 0); // on its upper half
    EXPECT_EQ(layout.directions[row], -1);
  }
  EXPECT_GT(run.result.contacts.at(0).resultant[2], 0.01);
}

// A ball whose middle is in the membrane's plane, and a skew roller that goes through it.
TEST(ObstacleMembraneTest, WhatIsOnBothSidesIsRefused) {
  const double s = std::sqrt(0.5);
  for (const scene::Obstacle& obstacle :
       {scene::Obstacle{scene::Obstacle::Kind::sphere, {0.5, 0.1, 0}, {0, 0, 1}, 0.05},
        scene::Obstacle{scene::Obstacle::Kind::cylinder, {0.5, 0.1, 0.01}, {s, 0, s}, 0.05}})
    EXPECT_THROW(test::solve(test::cutByMetis(strip(16, 1, -4, obstacle), 2), 1e-12), InputError);
}

} // namespace
