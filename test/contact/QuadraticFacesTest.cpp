#include "epafi/contact/QuadraticFaces.hpp"

#include "support/TurnedMesh.hpp"

#include "epafi/contact/SurfaceNodes.hpp"
#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace epafi {
namespace {

struct Side {
  mesh::UnstructuredMesh mesh;
  mesh::Surface surface;
  contact::SurfaceNodes nodes;
  contact::ContactLayout layout; ///< a row for each node

  explicit Side(bool simplices, mesh::InnerNodes inner = mesh::InnerNodes::added)
      : mesh(completed(epafi::test::arraysOf(mesh::StructuredMesh({{0, 0, 0}, {2, 3, 1}}, {2, 3, 1}),
                                             epafi::test::placed(3, 0.3, {1, 0, 0}), simplices),
                       false, inner)),
        surface(mesh.surface("top")),
        nodes(contact::surfaceNodes([&](GlobalOrdinal node) { return mesh.point(node); }, surface, 2)) {
    layout.firstNodes = nodes.nodes;
    layout.areas = nodes.areas;
    layout.directions.assign(3 * nodes.nodes.size(), 1.0);
    layout.gaps.assign(nodes.nodes.size(), 0.0);
    adaptRows(surface, layout);
  }
};

/// Six-node triangles, eight-node quadrilaterals.
std::array<Side, 2> dualSides() {
  return {Side(true), Side(false, mesh::InnerNodes::none)};
}

void expectConsistentForces(const Side& side) {
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

TEST(QuadraticFacesTest, AnEvenPressurePutsItsConsistentForcesOnTheNodes) {
  for (const Side& side : dualSides())
    expectConsistentForces(side);
}

/// Penetration of no node is possible: what rows allow, nodes obey.
void expectNoPenetration(const Side& side) {
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

TEST(QuadraticFacesTest, NodesPenetrateNowhereIfNoRowDoes) {
  for (const Side& side : dualSides())
    expectNoPenetration(side);
}

TEST(QuadraticFacesTest, FacesWithFourCornersKeepTheRowsOfTheirNodes) {
  const Side side(false);
  EXPECT_TRUE(side.layout.combinations.empty());
  EXPECT_EQ(side.layout.areas, side.nodes.areas);
  for (const double area : side.layout.areas)
    EXPECT_GT(area, 0.02);
}

TEST(QuadraticFacesTest, OtherFunctionsShareTheNodesOut) {
  for (const bool simplices : {false, true}) {
    const Side side(simplices);
    std::vector<double> sums(side.nodes.nodes.size(), 0.0);
    for (const auto& shares : side.layout.smoothed)
      for (const auto& share : shares) {
        EXPECT_GT(share.weight, 0);
        sums[share.node] += share.weight;
      }
    for (const double sum : sums)
      EXPECT_NEAR(sum, 1, 1e-15); // the resultant of forces stays
  }
}

/// Supports leave nodes of a tied joint fewer rows than others: components stay apart all the same.
TEST(QuadraticFacesTest, ComponentsOfATieAreSmoothedEachForItself) {
  for (const bool simplices : {false, true}) {
    const Side side(simplices);
    const std::size_t n = side.nodes.nodes.size(), numHeld = n / 3;
    contact::ContactLayout tie;
    for (int component = 0; component < 3; ++component)
      for (std::size_t k = component == 1 ? 0 : numHeld; k < n;
           ++k) { // the first and the last are held at some
        tie.firstNodes.push_back(side.nodes.nodes[k]);
        for (int d = 0; d < 3; ++d)
          tie.directions.push_back(d == component ? 1.0 : 0.0);
      }
    smoothRows(side.surface, tie);
    for (std::size_t row = 0; row < tie.firstNodes.size(); ++row)
      for (const auto& share : tie.smoothed[row])
        EXPECT_TRUE(std::equal(tie.directions.begin() + static_cast<std::ptrdiff_t>(3 * row),
                               tie.directions.begin() + static_cast<std::ptrdiff_t>(3 * row + 3),
                               tie.directions.begin() + static_cast<std::ptrdiff_t>(3 * share.node)));
    for (std::size_t k = 0; k < n; ++k) // the second has all rows, as a contact has
      EXPECT_EQ(tie.smoothed[n - numHeld + k].size(), side.layout.smoothed[k].size());
  }
}

/// On an even mesh of 4 × 4 facets of length 1, of p = |x|² in the surface, whose forces divided by areas
/// alternate.
void expectMeansOffBy(const mesh::Mesh& mesh, double off, int numInside) {
  const mesh::Surface surface = mesh.surface("top");
  const contact::SurfaceNodes nodes =
      contact::surfaceNodes([&](GlobalOrdinal node) { return mesh.point(node); }, surface, 2);
  contact::ContactLayout layout;
  layout.firstNodes = nodes.nodes;
  layout.areas = nodes.areas;
  contact::adaptRows(surface, layout);
  std::vector<double> forces(nodes.nodes.size(), 0.0);
  const auto& shape = mesh::referenceShape<2>(surface.facetType);
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto facet = surface.facet(f);
    for (const auto& sample : shape.fineSamples()) {
      Eigen::Vector3d x(0, 0, 0);
      std::vector<std::size_t> places;
      for (std::size_t a = 0; a < facet.size(); ++a) {
        places.push_back(std::lower_bound(nodes.nodes.begin(), nodes.nodes.end(), facet[a]) -
                         nodes.nodes.begin());
        x += sample.values[a] * nodes.points[places.back()];
      }
      for (std::size_t a = 0; a < facet.size(); ++a)
        forces[places[a]] += sample.weight / 4 * x.head<2>().squaredNorm() *
                             sample.values[a]; // the elements' edges are 1 long
    }
  }
  int inside = 0;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const Eigen::Vector3d& x = nodes.points[k];
    if (std::min({x[0], x[1], 4 - x[0], 4 - x[1]}) < 0.75)
      continue;
    ++inside;
    double force = 0, area = 0;
    for (const auto& share : layout.smoothed[k]) {
      force += share.weight * forces[share.node];
      area += share.weight * layout.areas[share.node];
    }
    if (layout.isDual)
      area = layout.areas[k];
    EXPECT_NEAR(force / area - x.head<2>().squaredNorm(), off, 1e-13);
  }
  EXPECT_EQ(inside, numInside);
}

TEST(QuadraticFacesTest, MeansOfAQuadraticPressureAreOffByTheSameEverywhere) {
  const mesh::StructuredMesh mesh({{0, 0, 0}, {4, 4, 1}}, {4, 4, 1}, 2);
  expectMeansOffBy(mesh, 0.1, 25); // h²/20 for each direction
  const mesh::UnstructuredMesh without(
      completed(epafi::test::arraysOf(mesh::StructuredMesh({{0, 0, 0}, {4, 4, 1}}, {4, 4, 1}), {}, false),
                false, mesh::InnerNodes::none));
  expectMeansOffBy(without, 13.0 / 60, 21);
}

} // namespace
} // namespace epafi
