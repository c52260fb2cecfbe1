// From one mesh to another: where points lie, and values there.

#include "epafi/accuracy/Transfer.hpp"

#include "Samples.hpp"

#include "support/SimplexSamples.hpp"

#include "epafi/accuracy/PointLocation.hpp"
#include "epafi/accuracy/Refinement.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <random>

namespace epafi::accuracy {
namespace {

using test::Field;
using TransferTest = test::AccuracyTest;

Point pointAt(const mesh::Mesh& mesh, const Location& location) {
  std::array<GlobalOrdinal, mesh::mostNodes> nodes{};
  const std::size_t number = mesh.nodesPerElement();
  mesh.elementNodes(location.element, std::span(nodes).first(number));
  Point point{};
  for (std::size_t i = 0; i < number; ++i)
    for (std::size_t d = 0; d < 3; ++d)
      point[d] += location.weights[i] * mesh.point(nodes[i])[d];
  return point;
}

TEST_F(TransferTest, EveryPointOfABodyIsFoundWhereItIs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0, 1);
  for (const test::Kind& kind : test::kinds()) {
    const auto decomposition = model::decompose(test::stackedBlocks(kind, 1, 1, directory, *comm), comm);
    const mesh::Mesh& mesh = *decomposition.bodies[0].mesh;
    PointLocation location(mesh);
    for (int k = 0; k < 200; ++k) {
      Point point{inside(random), inside(random), inside(random)};
      if (mesh::dimensionOf(kind.cell) == 2)
        point[2] = 0;
      if (k == 0)
        point = mesh.point(0);
      const Point found = pointAt(mesh, location.find(point));
      for (std::size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(found[d], point[d], 1e-12) << mesh::toString(kind.cell);
    }
    const Point outside =
        pointAt(mesh, location.find({1.05, 0.5, kind.physics == fem::Physics::elasticity3d ? 0.5 : 0}));
    EXPECT_NEAR(outside[0], 1, 0.2); // near, and in the body
    EXPECT_LE(outside[0], 1 + 1e-12);
  }
}

/// Twenty halvings towards a corner: elements of all sizes.
TEST_F(TransferTest, PointsAreFoundAmongElementsOfAllSizes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0, 1);
  for (mesh::SimplexMesh& simplices :
       std::vector{epafi::test::unevenGrid({2, 2, 0}), epafi::test::unevenGrid({1, 1, 1})}) {
    const int steps = simplices.dimension == 2 ? 20 : 7;
    for (int step = 0; step < steps; ++step) {
      std::vector<int> times;
      for (const mesh::SimplexMesh::Element& element : simplices.elements)
        times.push_back(std::find(element.corners.begin(), element.corners.begin() + simplices.dimension + 1,
                                  0) == element.corners.begin() + simplices.dimension + 1
                            ? 0
                            : simplices.dimension);
      bisect(simplices, times);
    }
    const mesh::UnstructuredMesh mesh(arraysOf(simplices, 1));
    const PointLocation location(mesh);
    for (int k = 0; k < 200; ++k) {
      const double scale = std::exp2(-k % (steps + 1));
      Point point{scale * inside(random), scale * inside(random), scale * inside(random)};
      if (simplices.dimension == 2)
        point[2] = 0;
      const Location found = location.find(point);
      const Point place = pointAt(mesh, found);
      for (std::size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(place[d], point[d], 1e-12);
      EXPECT_GE(*std::min_element(found.weights.begin(), found.weights.end()), -1e-9);
    }
  }
}

TEST_F(TransferTest, PointsOfCurvedElementsAreFoundAndNearOnesOfThoseBeyond) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0, 1);
  for (const std::array<int, 3>& elements : {std::array{2, 4, 0}, std::array{1, 4, 1}}) {
    const mesh::UnstructuredMesh mesh(
        arraysOf(simplicesOf(mesh::UnstructuredMesh(epafi::test::quarterRing(elements))), 2));
    const PointLocation location(mesh);
    for (int k = 0; k < 200; ++k) {
      const double angle = 0.5 * std::numbers::pi * inside(random);
      const auto at = [&, z = elements[2] == 0 ? 0 : inside(random)](double radius) {
        return Point{radius * std::cos(angle), radius * std::sin(angle), z};
      };
      const Point point = at(1.001 + 0.998 * inside(random));
      const Point found = pointAt(mesh, location.find(point));
      for (std::size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(found[d], point[d], 1e-10);
      const Location beyond = location.find(at(2.01));
      EXPECT_NEAR(std::accumulate(beyond.weights.begin(), beyond.weights.end(), 0.0), 1, 1e-12);
      const Point near = pointAt(mesh, beyond), wanted = at(2);
      EXPECT_LT(std::hypot(near[0] - wanted[0], near[1] - wanted[1], near[2] - wanted[2]), 0.05);
    }
  }
}

TEST_F(TransferTest, LinearFieldsAndCoarseOnesAreCarriedOverWithoutError) {
  const Field field = [](const Point& x) {
    return std::array<double, 3>{0.1 * x[0] - 0.2 * x[1], 0.3 * x[0] + 0.4 * x[1] - 0.1 * x[2], 0.2 * x[2]};
  };
  for (const test::Kind& kind : test::kinds()) {
    const scene::Scene scene = test::stackedBlocks(kind, 3, 1, directory, *comm);
    const auto coarse = model::decompose(scene, comm);
    const auto fine = model::decompose(refined(scene), comm);
    const auto u = displacement(coarse, field), expected = displacement(fine, field);
    const auto everywhere = interpolate(coarse, u, fine, NodesOf::subdomains),
               interfaces = interpolate(coarse, u, fine, NodesOf::interfaces);
    double somewhere = 0;
    for (std::size_t s = 0; s < expected.size(); ++s) {
      EXPECT_LE((everywhere[s] - expected[s]).lpNorm<Eigen::Infinity>(), 1e-12) << toString(kind.physics);
      for (Eigen::Index i = 0; i < expected[s].size(); ++i)
        if (interfaces[s][i] != 0) {
          EXPECT_NEAR(interfaces[s][i], expected[s][i], 1e-12);
          somewhere = 1;
        }
    }
    EXPECT_TRUE(expected.empty() || somewhere > 0);
  }
}

} // namespace
} // namespace epafi::accuracy
