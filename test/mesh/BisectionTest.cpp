// Simplices split in two, again and again: no node hangs, nothing is lost, no element gets flat.

#include "support/SimplexSamples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace epafi::mesh {
namespace {

using namespace test;

using test::measureOfGroup;
using test::measureOfSurface;
using test::measuresOf;
using test::quarterRing;
using test::soundBody;
using test::sumOf;
using test::unevenGrid;

/// Of straight elements.
std::vector<double> measuresOf(const SimplexMesh& mesh) {
  return measuresOf(UnstructuredMesh(arraysOf(mesh, 1)));
}

bool hasCorner(const SimplexMesh& mesh, std::size_t element, LocalOrdinal node) {
  const auto& corners = mesh.elements[element].corners;
  const auto end = corners.begin() + mesh.dimension + 1;
  return std::find(corners.begin(), end, node) != end;
}

/// The same number for some elements, 0 for the others.
std::vector<int> marks(const SimplexMesh& mesh, int times, const std::function<bool(std::size_t)>& isMarked) {
  std::vector<int> result;
  for (std::size_t element = 0; element < mesh.elements.size(); ++element)
    result.push_back(isMarked(element) ? times : 0);
  return result;
}

/// A share of the elements once or twice.
std::vector<int> randomMarks(const SimplexMesh& mesh, double share, SignedRandomNumbers& random) {
  std::vector<int> result;
  for (std::size_t element = 0; element < mesh.elements.size(); ++element) {
    const bool isMarked = random() > 1 - 2 * share;
    result.push_back(!isMarked ? 0 : random() > 0.5 ? 2 : 1);
  }
  return result;
}

double smallestAngle(const SimplexMesh& mesh) {
  double smallest = std::numbers::pi;
  for (const SimplexMesh::Element& element : mesh.elements)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = [&](std::size_t k) { return vectorOf(mesh.points[element.corners[(i + k) % 3]]); };
      const Eigen::Vector3d a = corner(1) - corner(0), b = corner(2) - corner(0);
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  return smallest;
}

/// The least volume by the cube of the longest edge.
double worstShape(const SimplexMesh& mesh) {
  double worst = 1;
  const std::vector<double> volumes = measuresOf(mesh);
  std::vector<Point> points(4);
  for (std::size_t element = 0; element < volumes.size(); ++element) {
    for (std::size_t i = 0; i < 4; ++i)
      points[i] = mesh.points[mesh.elements[element].corners[i]];
    worst = std::min(worst, volumes[element] / std::pow(diameterOf(points), 3));
  }
  return worst;
}

std::vector<SimplexMesh> unevenGrids() {
  return {unevenGrid({4, 4, 0}), unevenGrid({2, 2, 2})};
}

double shareOf(const SimplexMesh& mesh) {
  return mesh.dimension == 2 ? 0.2 : 0.05;
}

TEST(BisectionTest, HalvesTheLongestEdgeFromBothSides) {
  SimplexMesh square = simplicesOf(StructuredMesh({{0, 0, 0}, {1, 1, 0}}, {1, 1, 0}));
  const std::vector<LocalOrdinal> ancestors = bisect(square, {1, 0});
  EXPECT_EQ(ancestors, (std::vector<LocalOrdinal>{0, 1, 0, 1}));
  ASSERT_EQ(square.points.size(), 5U);
  EXPECT_EQ(square.points[4], (Point{0.5, 0.5, 0}));
  for (std::size_t element = 0; element < 4; ++element)
    EXPECT_TRUE(hasCorner(square, element, 4));
  for (const double area : measuresOf(square))
    EXPECT_NEAR(area, 0.25, 1e-15);
}

TEST(BisectionTest, OfEqualEdgesThatBetweenTheHigherNodesIsHalved) {
  SimplexMesh even; // of edges of length √2
  even.dimension = 3;
  even.points = {{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  even.elements = {{{0, 1, 3, 2}, {}, 0}};
  bisect(even, {1});
  ASSERT_EQ(even.points.size(), 5U);
  EXPECT_EQ(even.points[4], (Point{0, 0.5, 0.5}));
}

TEST(BisectionTest, WhereNothingIsMarkedNothingIsSplit) {
  for (SimplexMesh& mesh : unevenGrids()) {
    const MeshArrays before = arraysOf(mesh, 1);
    const std::vector<LocalOrdinal> ancestors = bisect(mesh, std::vector<int>(mesh.elements.size(), 0));
    EXPECT_EQ(arraysOf(mesh, 1).cells, before.cells);
    EXPECT_EQ(mesh.points, before.points);
    for (std::size_t element = 0; element < ancestors.size(); ++element)
      EXPECT_EQ(ancestors[element], static_cast<LocalOrdinal>(element));
  }
}

TEST(BisectionTest, WhicheverElementIsSplitTheMeshStaysSound) {
  for (const SimplexMesh& grid : unevenGrids())
    for (std::size_t element = 0; element < grid.elements.size(); ++element) {
      SimplexMesh mesh = grid;
      const std::vector<LocalOrdinal> ancestors =
          bisect(mesh, marks(mesh, 1, [&](std::size_t e) { return e == element; }));
      EXPECT_GE(std::count(ancestors.begin(), ancestors.end(), static_cast<LocalOrdinal>(element)), 2);
      EXPECT_NEAR(sumOf(measuresOf(soundBody(mesh))), 1, 1e-13);
    }
}

TEST(BisectionTest, RandomMarksKeepTheMeshSoundItsSurfacesAndItsGroups) {
  for (SimplexMesh& mesh : unevenGrids()) {
    SignedRandomNumbers random(5);
    const UnstructuredMesh first = soundBody(mesh);
    for (int round = 0; round < 5; ++round) {
      const std::vector<Point> points = mesh.points;
      bisect(mesh, randomMarks(mesh, shareOf(mesh), random));
      EXPECT_TRUE(std::equal(points.begin(), points.end(), mesh.points.begin())); // they keep their numbers
      const UnstructuredMesh body = soundBody(mesh);
      EXPECT_NEAR(sumOf(measuresOf(body)), 1, 1e-13);
      EXPECT_EQ(body.surfaceNames(), first.surfaceNames());
      for (const std::string& name : first.surfaceNames())
        EXPECT_NEAR(measureOfSurface(body, name), 1, 1e-13) << name;
      EXPECT_NEAR(measureOfGroup(body, "third"), measureOfGroup(first, "third"), 1e-13);
    }
  }
}

TEST(BisectionTest, PartsMakeUpTheirAncestorsAndAreAsManyAsWereAskedFor) {
  for (SimplexMesh& mesh : unevenGrids()) {
    SignedRandomNumbers random(3);
    for (int round = 0; round < 4; ++round) {
      const std::vector<double> before = measuresOf(mesh);
      const std::vector<int> times = randomMarks(mesh, shareOf(mesh), random);
      const std::vector<SimplexMesh::Element> old = mesh.elements;
      const std::vector<LocalOrdinal> ancestors = bisect(mesh, times);
      const std::vector<double> after = measuresOf(mesh);
      ASSERT_EQ(ancestors.size(), mesh.elements.size());
      std::vector<double> sums(before.size(), 0);
      std::vector<int> numbers(before.size(), 0);
      for (std::size_t element = 0; element < ancestors.size(); ++element) {
        const std::size_t ancestor = ancestors[element];
        sums[ancestor] += after[element];
        ++numbers[ancestor];
        EXPECT_EQ(mesh.elements[element].group, old[ancestor].group);
      }
      for (std::size_t ancestor = 0; ancestor < before.size(); ++ancestor) {
        EXPECT_NEAR(sums[ancestor], before[ancestor], 1e-13);
        EXPECT_GE(numbers[ancestor], 1 << times[ancestor]);
      }
    }
  }
}

/// Rosenberg, Stenger: A lower bound on the angles of triangles constructed by bisecting the longest side
/// (1975).
TEST(BisectionTest, AnglesInThePlaneStayAboveHalfOfTheSmallest) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    SimplexMesh mesh = unevenGrid({4, 4, 0}, seed);
    const double first = smallestAngle(mesh);
    SignedRandomNumbers random(seed);
    for (int round = 0; round < 7; ++round) {
      bisect(mesh, randomMarks(mesh, 0.2, random));
      EXPECT_GE(smallestAngle(mesh), 0.5 * first * (1 - 1e-9));
    }
  }
}

TEST(BisectionTest, TetrahedraTowardsACornerDoNotGetFlatterWithoutEnd) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    SimplexMesh mesh = unevenGrid({3, 3, 3}, seed);
    constexpr LocalOrdinal inner = 1 + 4 * (1 + 4); // a node that was moved
    double early = worstShape(mesh);
    for (int round = 0; round < 12; ++round) {
      bisect(mesh, marks(mesh, 1, [&](std::size_t e) { return hasCorner(mesh, e, inner); }));
      if (round < 6)
        early = std::min(early, worstShape(mesh));
      else
        EXPECT_GE(worstShape(mesh), 0.9 * early) << "round " << round;
    }
  }
}

TEST(BisectionTest, TowardsACornerEveryRoundAddsAboutAsManyElements) {
  for (SimplexMesh& mesh : unevenGrids()) {
    constexpr int rounds = 10;
    std::vector<std::size_t> added;
    const auto largest = [&] { // of the elements at the corner
      const std::vector<double> measures = measuresOf(mesh);
      double result = 0;
      for (std::size_t element = 0; element < measures.size(); ++element)
        if (hasCorner(mesh, element, 0))
          result = std::max(result, measures[element]);
      return result;
    };
    const double first = largest();
    for (int round = 0; round < rounds; ++round) {
      const std::size_t before = mesh.elements.size();
      bisect(mesh, marks(mesh, mesh.dimension, [&](std::size_t e) { return hasCorner(mesh, e, 0); }));
      added.push_back(mesh.elements.size() - before);
    }
    EXPECT_LE(largest(), first * std::exp2(-rounds * mesh.dimension) * (1 + 1e-12));
    EXPECT_LE(*std::max_element(added.begin(), added.end()), 2 * added.front());
    EXPECT_NEAR(sumOf(measuresOf(soundBody(mesh))), 1, 1e-13);
  }
}

/// The new node of an arc, and those of its halves, on the parabola of the arc that they come from.
TEST(BisectionTest, NodesOfCurvedEdgesLieOnTheirParabola) {
  SimplexMesh mesh = simplicesOf(UnstructuredMesh(quarterRing({2, 2, 0})));
  const UnstructuredMesh first = soundBody(mesh, 2);
  const Surface arcs = first.surface("right");
  SignedRandomNumbers random(3);
  for (int round = 0; round < 4; ++round) {
    bisect(mesh, randomMarks(mesh, 0.4, random));
    const UnstructuredMesh body = soundBody(mesh, 2);
    const Surface outer = body.surface("right");
    for (const GlobalOrdinal node : outer.facetNodes) {
      const Eigen::Vector3d x = vectorOf(body.point(node));
      double nearest = 1;
      for (std::size_t f = 0; f < arcs.numFacets(); ++f) {
        const Eigen::Vector3d a = vectorOf(first.point(arcs.facet(f)[0])),
                              b = vectorOf(first.point(arcs.facet(f)[1])),
                              bend = vectorOf(first.point(arcs.facet(f)[2])) - 0.5 * (a + b);
        const double t =
            (x - a).dot(b - a) / (b - a).squaredNorm(); // the bend is at right angles to the chord
        if (t > -1e-9 && t < 1 + 1e-9)
          nearest = std::min(nearest, (a + t * (b - a) + 4 * t * (1 - t) * bend - x).norm());
      }
      EXPECT_LT(nearest, 1e-13);
    }
  }
  EXPECT_GT(soundBody(mesh, 2).surface("right").numFacets(), 2 * arcs.numFacets());
}

/// Parts have the quadratic map of their ancestor.
TEST(BisectionTest, CurvedElementsKeepTheirSize) {
  for (const std::array<int, 3>& elements : {std::array{2, 3, 0}, std::array{1, 2, 1}}) {
    SimplexMesh mesh = simplicesOf(UnstructuredMesh(quarterRing(elements)));
    SignedRandomNumbers random(3);
    for (int round = 0; round < 4; ++round) {
      const std::vector<double> before = measuresOf(soundBody(mesh, 2));
      const std::vector<LocalOrdinal> ancestors = bisect(mesh, randomMarks(mesh, 0.3, random));
      const std::vector<double> after = measuresOf(soundBody(mesh, 2));
      std::vector<double> sums(before.size(), 0);
      for (std::size_t element = 0; element < after.size(); ++element)
        sums[ancestors[element]] += after[element];
      for (std::size_t ancestor = 0; ancestor < before.size(); ++ancestor)
        EXPECT_NEAR(sums[ancestor], before[ancestor], 1e-13);
    }
  }
}

/// Lengths that differ by a part in 10⁹, as in files with ten digits: both sides of a face have to agree on
/// which edge is longest.
TEST(BisectionTest, EdgesThatAreAlmostEquallyLongLeaveNoCracks) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed)
    for (const double step : {2e-10, 3e-10}) {
      SignedRandomNumbers random(seed);
      MeshArrays arrays = test::moved(StructuredMesh({{0, 0, 0}, {1, 1, 1}}, {2, 2, 2}),
                                      [](const Point& point) { return point; });
      std::vector<LocalOrdinal> number(arrays.points.size());
      std::iota(number.begin(), number.end(), 0);
      for (std::size_t last = number.size() - 1; last > 0; --last)
        std::swap(
            number[last],
            number[static_cast<std::size_t>((random() + 1) / 2.000001 * static_cast<double>(last + 1))]);
      const std::vector<Point> points = arrays.points;
      for (std::size_t node = 0; node < points.size(); ++node)
        arrays.points[number[node]] = points[node];
      for (Point& point : arrays.points)
        for (double& coordinate : point)
          coordinate += step * random();
      for (LocalOrdinal& node : arrays.cells)
        node = number[node];
      for (NamedFacets& surface : arrays.surfaces)
        for (LocalOrdinal& node : surface.nodes)
          node = number[node];
      SimplexMesh mesh = simplicesOf(UnstructuredMesh(arrays));
      for (int round = 0; round < 3; ++round)
        bisect(mesh, randomMarks(mesh, 0.2, random));
      SCOPED_TRACE(seed);
      (void)soundBody(mesh);
    }
}

TEST(BisectionTest, TheSameMarksGiveTheSameMesh) {
  for (const SimplexMesh& grid : {unevenGrid({4, 4, 0}), unevenGrid({2, 2, 2}),
                                  simplicesOf(UnstructuredMesh(quarterRing({1, 2, 1})))}) {
    SimplexMesh one = grid, other = grid;
    SignedRandomNumbers ofOne(3), ofOther(3);
    for (int round = 0; round < 3; ++round)
      EXPECT_EQ(bisect(one, randomMarks(one, 0.2, ofOne)), bisect(other, randomMarks(other, 0.2, ofOther)));
    const MeshArrays a = arraysOf(one, 2), b = arraysOf(other, 2);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.cells, b.cells);
  }
}

} // namespace
} // namespace epafi::mesh
