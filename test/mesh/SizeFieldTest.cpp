// Sizes that meshes are to have, and meshes that have them.

#include "epafi/mesh/SizeField.hpp"

#include "support/GmshPlate.hpp"

#include "epafi/mesh/SimplexMesh.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/meshing/GmshReader.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>
#include <utility>

namespace epafi::mesh {
namespace {

using test::measureOf;
using test::vectorOf;

using SizeFieldTest = test::GmshTest;
using Size = std::function<double(const Point&)>;

/// A function at the corners of simplices on the unit square or cube.
MeshSizes sizesOf(int dimension, const Size& size) {
  const SimplexMesh mesh =
      simplicesOf(StructuredMesh({{0, 0, 0}, {1, 1, 1}}, {3, 4, dimension == 2 ? 0 : 2}));
  MeshSizes sizes{dimension, {}, {}};
  for (const SimplexMesh::Element& element : mesh.elements)
    for (int i = 0; i <= dimension; ++i) {
      sizes.corners.push_back(mesh.points[element.corners[i]]);
      sizes.sizes.push_back(size(sizes.corners.back()));
    }
  return sizes;
}

double linear(const Point& x) {
  return 20 + x[0] - 2 * x[1] + 3 * x[2];
}

TEST_F(SizeFieldTest, IsLinearBetweenCornersAndExactAtThem) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0, 1);
  for (const int dimension : {2, 3}) {
    const MeshSizes sizes = sizesOf(dimension, linear);
    const SizeField field(sizes);
    for (std::size_t i = 0; i < sizes.corners.size(); ++i)
      EXPECT_NEAR(field.at(sizes.corners[i]), sizes.sizes[i], 1e-12);
    for (int k = 0; k < 200; ++k) {
      Point point{inside(random), inside(random), inside(random)};
      if (dimension == 2)
        point[2] = 0;
      EXPECT_NEAR(field.at(point), linear(point), 1e-12);
    }
  }
}

TEST_F(SizeFieldTest, BeyondTheBodyItIsThatOfTheNearestPoint) {
  const SizeField triangle({2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 2, 4}});
  EXPECT_NEAR(triangle.at({-5, -5, 0}), 1, 1e-14);
  EXPECT_NEAR(triangle.at({3, -1, 0}), 2, 1e-14);
  EXPECT_NEAR(triangle.at({-1, 7, 0}), 4, 1e-14);
  EXPECT_NEAR(triangle.at({0.5, -0.01, 0}), 1.5, 0.02); // as far as a round border is beyond a chord
  const SizeField two(
      {2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 0, 0}, {10, 0, 0}, {9, 1, 0}}, {1, 1, 1, 3, 3, 3}});
  EXPECT_NEAR(two.at({2, 0.5, 0}), 1, 1e-14);
  EXPECT_NEAR(two.at({8, 0.5, 0}), 3, 1e-14);
  EXPECT_NEAR(SizeField({3, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {1, 2, 3, 4}}).at({-1, -1, 9}), 4,
              1e-14);
}

TEST_F(SizeFieldTest, IsNeverBeyondTheSizesThatItIsMadeOf) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-2, 3);
  for (const int dimension : {2, 3}) {
    const SizeField field(sizesOf(dimension, [](const Point& x) { return 2 + std::cos(9 * x[0] + x[1]); }));
    for (int k = 0; k < 100; ++k) {
      const double size =
          field.at({anywhere(random), anywhere(random), dimension == 2 ? 0.0 : anywhere(random)});
      EXPECT_GE(size, 1 - 1e-12);
      EXPECT_LE(size, 3 + 1e-12);
    }
  }
}

TEST_F(SizeFieldTest, WhereSimplicesOverlapTheSmallerSizeHolds) {
  const Point a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0}, d{1, 1, 0}, e{2, 1, 0}, f{1, 2, 0};
  for (const bool isLargeFirst : {true, false}) {
    const SizeField field(isLargeFirst ? MeshSizes{2, {a, b, c, d, e, f}, {3, 3, 3, 1, 1, 1}}
                                       : MeshSizes{2, {d, e, f, a, b, c}, {1, 1, 1, 3, 3, 3}});
    EXPECT_NEAR(field.at({1.25, 1.25, 0}), 1, 1e-14);
    EXPECT_NEAR(field.at({0.5, 0.5, 0}), 3, 1e-14);
  }
}

TEST_F(SizeFieldTest, BeyondTheBodyASmallSimplexCanBeNearerThanALargeOne) {
  const SizeField field({2,
                         {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {-2, -1, 0}, {-1, -1, 0}, {-1, 0, 0}},
                         {0.01, 0.01, 0.01, 1, 1, 1}});
  EXPECT_NEAR(field.at({-0.05, 0, 0}), 0.01, 1e-14); // 0.05 from the one, 0.95 from the other
}

/// Two bodies of one geometry that touch, each with its own sizes: a point of both is outside of either by
/// round-off.
TEST_F(SizeFieldTest, WhereBodiesTouchTheSmallerSizeHolds) {
  const Point a{0.1, 0.3, 0}, b{0.7, 0.8, 0}, below{0.9, 0.1, 0}, above{0.2, 0.9, 0};
  const SizeField field({2, {a, below, b, a, b, above}, {1, 1, 1, 0.1, 0.1, 0.1}});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0, 1);
  for (int k = 0; k < 100; ++k) {
    const double t = inside(random);
    EXPECT_NEAR(field.at({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), 0}), 0.1, 1e-12);
  }
}

/// A square or cube of side 1 that says itself that two elements a side are enough.
const std::string squareGeometry = R"(
lc = 0.5;
Point(1) = {0, 0, 0, lc}; Point(2) = {1, 0, 0, lc}; Point(3) = {1, 1, 0, lc}; Point(4) = {0, 1, 0, lc};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("plate") = {1};
Physical Curve("bottom") = {1};
)";
const std::string cube = R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Mesh.MeshSizeMax = 0.5;
Physical Volume("block") = {1};
Physical Surface("sides") = {1, 2, 3, 4, 5, 6};
)";

UnstructuredMesh meshWith(const std::string& file, const MeshSizes& sizes) {
  return meshing::GmshFile(meshing::readMsh(file, meshing::textOfGeometry(file, 1, SizeField(sizes))))
      .body("");
}

/// Mean length of edges in units of the size in their middle, of those where `isThere` holds.
double meanEdge(
    const Mesh& mesh, const Size& size,
    const std::function<bool(const Point&)>& isThere = [](const Point& /*x*/) { return true; }) {
  std::set<std::pair<GlobalOrdinal, GlobalOrdinal>> edges;
  const auto places = edgesOf(mesh.cellType());
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const ElementNodes nodes(mesh, element);
    for (std::size_t e = 0; e < places.size(); e += 2)
      edges.insert(std::minmax(nodes[places[e]], nodes[places[e + 1]]));
  }
  double sum = 0, number = 0;
  for (const auto& [low, high] : edges) {
    const std::array<Point, 2> ends{mesh.point(low), mesh.point(high)};
    const Point middle = centreOf(ends);
    if (!isThere(middle))
      continue;
    sum += diameterOf(ends) / size(middle);
    ++number;
  }
  return sum / number;
}

Size constant(double size) {
  return [size](const Point& /*x*/) { return size; };
}

constexpr double closeEnough = 0.3; // Gmsh makes what it is asked for on average

TEST_F(SizeFieldTest, GeometriesAreMeshedWithTheSizesThatAreAskedForAndNotWithTheirOwn) {
  const std::string plate = folder.write("square.geo", squareGeometry),
                    block = folder.write("cube.geo", cube);
  for (const double size : {0.2, 0.05}) {
    const UnstructuredMesh mesh = meshWith(plate, sizesOf(2, constant(size)));
    EXPECT_EQ(mesh.cellType(), CellType::triangle6);
    EXPECT_NEAR(meanEdge(mesh, constant(size)), 1, closeEnough);
  }
  const UnstructuredMesh solid = meshWith(block, sizesOf(3, constant(0.3)));
  EXPECT_EQ(solid.cellType(), CellType::tetrahedron10);
  EXPECT_NEAR(meanEdge(solid, constant(0.3)), 1, closeEnough);
}

TEST_F(SizeFieldTest, FieldsAndMeshesThatAGeometryGivesDoNotMatter) {
  const std::string field = "Field[1] = MathEval;\nField[1].F = \"0.05\";\nBackground Field = 1;\n",
                    meshes = "Mesh 2;\n";
  for (const std::string& more : {field, meshes}) {
    const std::string plate = folder.write("square.geo", squareGeometry + more);
    const double size = more == field ? 0.2 : 0.05;
    const UnstructuredMesh mesh = meshWith(plate, sizesOf(2, constant(size)));
    EXPECT_NEAR(meanEdge(mesh, constant(size)), 1, closeEnough) << more;
    EXPECT_NEAR(meanEdge(mesh, constant(size), [](const Point& x) { return x[1] == 0; }), 1, closeEnough)
        << more;
  }
}

TEST_F(SizeFieldTest, GeometriesAreMeshedFinelyWhereThatIsAskedForAlone) {
  const Size graded = [](const Point& x) { return 0.02 + 0.1 * (x[0] + x[1]); };
  const UnstructuredMesh mesh = meshWith(folder.write("square.geo", squareGeometry), sizesOf(2, graded));
  EXPECT_NEAR(meanEdge(mesh, graded, [](const Point& x) { return x[0] + x[1] < 0.3; }), 1, closeEnough);
  EXPECT_NEAR(meanEdge(mesh, graded, [](const Point& x) { return x[0] + x[1] > 1.4; }), 1, closeEnough);
}

TEST_F(SizeFieldTest, GroupsOfAGeometryAreStillThere) {
  const UnstructuredMesh mesh =
      meshWith(folder.write("square.geo", squareGeometry), sizesOf(2, constant(0.2)));
  EXPECT_EQ(mesh.groupNames(), std::vector<std::string>{"plate"});
  EXPECT_EQ(static_cast<GlobalOrdinal>(mesh.group("plate").size()), mesh.numElements());
  EXPECT_EQ(mesh.surfaceNames(), std::vector<std::string>{"bottom"});
  EXPECT_NEAR(measureOf(mesh), 1, 1e-14);
  const Surface bottom = mesh.surface("bottom");
  EXPECT_NEAR(static_cast<double>(bottom.numFacets()), 5, 2);
  for (const GlobalOrdinal node : bottom.facetNodes)
    EXPECT_NEAR(mesh.point(node)[1], 0, 1e-14);
}

TEST_F(SizeFieldTest, NewNodesLieOnTheRoundBordersOfAGeometry) {
  const UnstructuredMesh mesh = meshWith(folder.write("disk.geo", R"(
lc = 1;
Point(1) = {0, 0, 0, lc}; Point(2) = {1, 0, 0, lc}; Point(3) = {0, 1, 0, lc}; Point(4) = {-1, 0, 0, lc};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 2};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Physical Surface("half") = {1};
Physical Curve("rim") = {1, 2};
)"),
                                         sizesOf(2, constant(0.2)));
  for (const GlobalOrdinal node : mesh.surface("rim").facetNodes)
    EXPECT_NEAR(vectorOf(mesh.point(node)).norm(), 1, 1e-9);
}

TEST_F(SizeFieldTest, RefusesWhatIsNoGeometryOrCannotBeMeshed) {
  const MeshSizes sizes = sizesOf(2, constant(0.2));
  test::expectRefusal([&] { meshWith(folder.path("none.geo"), sizes); }, {"none.geo", "There is no"});
  test::expectRefusal(
      [&] { meshWith(folder.write("bad.geo", "Point(1) = {0, 0, 0};\nLine(1) = {1, 2};\n"), sizes); },
      {"bad.geo", "Gmsh says"});
}

} // namespace
} // namespace epafi::mesh
