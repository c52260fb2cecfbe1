#include "epafi/contact/BasisChange.hpp"

#include "../fem/TurnedMesh.hpp"

#include "epafi/contact/SurfaceNodes.hpp"
#include "epafi/fem/MeshOrder.hpp"
#include "epafi/fem/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace epafi {
namespace {

struct Side {
  fem::UnstructuredMesh mesh;
  fem::Surface surface;
  contact::SurfaceNodes nodes;
  contact::ContactLayout layout; ///< a row for each node

  explicit Side(bool simplices)
      : mesh(completed(arraysOf(fem::StructuredMesh({{0, 0, 0}, {2, 3, 1}}, {2, 3, 1}),
                                fem::test::placed(3, 0.3, {1, 0, 0}), simplices),
                       false)),
        surface(mesh.surface("top")), nodes(contact::surfaceNodes(mesh, surface)) {
    layout.firstNodes = nodes.nodes;
    layout.areas = nodes.areas;
    layout.directions.assign(3 * nodes.nodes.size(), 1.0);
    layout.gaps.assign(nodes.nodes.size(), 0.0);
    changeBasis(mesh, surface, layout);
  }
};

TEST(BasisChangeTest, AnEvenPressurePutsItsConsistentForcesOnTheNodes) {
  const Side side(true);
  std::vector<double> forces(side.nodes.nodes.size(), 0.0);
  for (std::size_t row = 0; row < side.layout.firstNodes.size(); ++row) {
    EXPECT_GT(side.layout.areas[row], 0.05);
    double sum = 0;
    side.layout.forEachShare(row, [&](std::size_t node, double weight) {
      forces[node] += weight * side.layout.areas[row];
      sum += weight;
    });
    EXPECT_NEAR(sum, 1, 1e-15); // a translation is one
  }
  for (std::size_t node = 0; node < forces.size(); ++node)
    EXPECT_NEAR(forces[node], side.nodes.areas[node], 1e-14);
  EXPECT_NEAR(std::accumulate(side.layout.areas.begin(), side.layout.areas.end(), 0.0), 6, 1e-13);
}

/// Penetration of no node is possible: what rows allow, nodes obey.
TEST(BasisChangeTest, NodesPenetrateNowhereIfNoRowDoes) {
  const Side side(true);
  std::vector<double> opening(side.nodes.nodes.size());
  for (std::size_t node = 0; node < opening.size(); ++node) // corners first: they are their own rows
    if (side.layout.combinations[node].size() == 1)
      opening[node] = 0.1 * static_cast<double>(node % 3);
  for (std::size_t row = 0; row < opening.size(); ++row)
    if (side.layout.combinations[row].size() > 1) { // closed in the row's sense
      double others = 0, own = 0;
      side.layout.forEachShare(row, [&](std::size_t node, double weight) {
        (node == row ? own : others) += node == row ? weight : weight * opening[node];
      });
      EXPECT_GE(-others / own, 0);
    }
}

TEST(BasisChangeTest, FacesWithFourCornersKeepTheRowsOfTheirNodes) {
  const Side side(false);
  EXPECT_TRUE(side.layout.combinations.empty());
  EXPECT_EQ(side.layout.areas, side.nodes.areas);
  for (const double area : side.layout.areas)
    EXPECT_GT(area, 0.02);
}

} // namespace
} // namespace epafi
