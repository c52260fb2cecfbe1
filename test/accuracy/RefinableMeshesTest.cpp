// Meshes of a scene as they are refined: split, or made anew on their geometry; on all ranks alike.

#include "epafi/accuracy/RefinableMeshes.hpp"

#include "RefinementSamples.hpp"

#include "support/Refusal.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <numbers>
#include <set>

namespace epafi::accuracy {
namespace {

using test::distance;
using test::elementsOf;
using test::measureOf;
using test::roundOff;
using test::sumOf;
using test::Values;
using Ancestors = std::vector<LocalOrdinal>;

struct RefinableMeshesTest : test::RefinementTest {
  /// Writes a geometry on rank 0. Collective.
  [[nodiscard]] std::string geometry(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = directory.path() / name;
    if (comm->getRank() == 0)
      std::ofstream(file) << text;
    comm->barrier();
    return file.string();
  }

  /// A membrane on a group of a file.
  [[nodiscard]] static scene::Scene membraneOn(const std::string& file,
                                               const std::vector<std::string>& groups) {
    scene::Scene scene;
    for (const std::string& group : groups) {
      scene::Body& body = scene.bodies.emplace_back();
      body.name = group;
      body.mesh.file = file;
      body.mesh.group = group;
    }
    return scene;
  }
};

const auto everywhereOnce = [](const Point& /*x*/) { return 1.0; };

TEST_F(RefinableMeshesTest, AllRanksHaveTheSameMeshes) {
  const auto expectSame = [&](const std::vector<double>& values) {
    int size = static_cast<int>(values.size());
    std::vector<double> ofFirst(values);
    Teuchos::broadcast(*comm, 0, 1, &size);
    ofFirst.resize(size);
    Teuchos::broadcast(*comm, 0, size, ofFirst.data());
    EXPECT_EQ(values, ofFirst);
  };
  const auto onRight = [](const Point& x) { return x[0] > 0.7 ? 0.4 : 0.0; }; // once
  std::vector<scene::Scene> scenes{membraneOn(geometry("square.geo", R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Mesh.MeshSizeMax = 0.4;
Physical Surface("square") = {1};
)"),
                                              {"square"})};
  for (const test::Kind& kind : test::kinds())
    scenes.push_back(test::stackedBlocks(kind, 1, 1, directory, *comm));
  for (const scene::Scene& scene : scenes) {
    RefinableMeshes meshes(scene, *comm);
    for (int round = 0; round < 2; ++round) {
      for (const Ancestors& own : meshes.refine(halvings(meshes, onRight), *comm))
        expectSame({own.begin(), own.end()});
      for (const model::BodyLayout& body : bodiesOf(meshes, 2)) {
        std::vector<double> points;
        for (const std::vector<Point>& element : elementsOf(*body.mesh))
          for (const Point& point : element)
            points.insert(points.end(), point.begin(), point.end());
        expectSame(points);
      }
    }
  }
}

TEST_F(RefinableMeshesTest, PartsMakeUpTheirAncestorsAndSurfacesStay) {
  for (const test::Kind& kind : test::kinds()) {
    const scene::Scene scene = test::stackedBlocks(kind, 1, 1, directory, *comm);
    RefinableMeshes meshes(scene, *comm);
    const auto wanted = halvings(meshes, [](const Point& x) { return x[0] < 0.3 ? 1.0 : 0.0; });
    const std::vector<Values> before = meshes.measures();
    const std::vector<Ancestors> ancestors = meshes.refine(wanted, *comm);
    const std::vector<Values> after = meshes.measures();
    ASSERT_EQ(ancestors.size(), 2U);
    for (std::size_t b = 0; b < 2; ++b) {
      ASSERT_EQ(ancestors[b].size(), after[b].size());
      Values sums(before[b].size(), 0), numbers(before[b].size(), 0);
      for (std::size_t e = 0; e < after[b].size(); ++e) {
        sums[ancestors[b][e]] += after[b][e];
        ++numbers[ancestors[b][e]];
      }
      for (std::size_t e = 0; e < before[b].size(); ++e) {
        EXPECT_NEAR(sums[e], before[b][e], roundOff);
        EXPECT_GE(numbers[e], std::exp2(mesh::dimensionOf(kind.cell) * wanted[b][e]));
      }
    }
    const auto bodies = bodiesOf(meshes);
    for (const std::size_t b : {0U, 1U}) {
      EXPECT_EQ(static_cast<std::size_t>(bodies[b].mesh->numElements()), after[b].size());
      for (const std::string name : {"left", "bottom", "top"}) {
        const mesh::Surface surface = bodies[b].mesh->surface(name);
        double area = 0;
        std::vector<Point> points;
        for (std::size_t f = 0; f < surface.numFacets(); ++f) {
          bodies[b].mesh->pointsAt(surface.facet(f), points);
          area += mesh::areaVector(surface.facetType, points).norm();
        }
        EXPECT_NEAR(area, 1, roundOff) << name;
      }
    }
  }
}

/// 2^(d·halvings) times as many elements at least, also if each of them wants a part of a bisection.
TEST_F(RefinableMeshesTest, AGrowthThatIsWantedEverywhereIsMade) {
  for (const double halving : {0.2, 0.35}) {
    RefinableMeshes meshes(test::membrane(4, 2), *comm);
    meshes.refine(halvings(meshes, [](const Point& /*x*/) { return 1.0; }), *comm);
    const auto before = static_cast<double>(meshes.measures()[0].size());
    meshes.refine(halvings(meshes, [&](const Point& /*x*/) { return halving; }), *comm);
    const auto after = static_cast<double>(meshes.measures()[0].size());
    EXPECT_GE(after / before, 0.95 * std::exp2(2 * halving));
    EXPECT_LE(after / before, 1.5 * std::exp2(2 * halving)) << "no more than keeps nodes from hanging";
  }
}

TEST_F(RefinableMeshesTest, PartsAreForetoldAsTheyAreMade) {
  const auto inACorner = [](const Point& x) { return x[0] + x[1] < 0.5 ? 1.3 : 0.0; };
  for (const test::Kind& kind : test::kinds()) {
    RefinableMeshes meshes(test::stackedBlocks(kind, 1, 1, directory, *comm), *comm);
    for (int round = 0; round < 2; ++round) {
      const std::vector<Values> wanted = halvings(meshes, inACorner);
      const std::vector<Values> foretold = meshes.parts(wanted);
      const std::vector<Ancestors> ancestors = meshes.refine(wanted, *comm);
      for (std::size_t b = 0; b < ancestors.size(); ++b) {
        Values made(wanted[b].size(), 0.0);
        for (const LocalOrdinal ancestor : ancestors[b])
          ++made[ancestor];
        EXPECT_EQ(made, foretold[b]) << toString(kind.physics) << ", body " << b;
      }
    }
  }
}

TEST_F(RefinableMeshesTest, BodiesAreCutIntoMorePartsAsTheirMeshesGrow) {
  RefinableMeshes meshes(test::membrane(4, 2), *comm);
  const scene::Scene first = meshes.scene(1);
  EXPECT_EQ(first.bodies[0].decomposition.method, scene::Decomposition::Method::metis);
  EXPECT_EQ(bodiesOf(meshes, 1)[0].partition->numParts(), 1);
  EXPECT_EQ(first.bodies[0].mesh.order, 1);
  EXPECT_EQ(first.bodies[0].name, "membrane");
  meshes.refine(halvings(meshes, [](const Point& /*x*/) { return 4.0; }), *comm);
  const scene::Scene finer = meshes.scene(2);
  EXPECT_EQ(finer.bodies[0].mesh.order, 2);
  const auto bodies = bodiesOf(meshes, 2);
  EXPECT_GT(bodies[0].partition->numParts(), bodiesOf(meshes, 1)[0].partition->numParts());
  EXPECT_EQ(bodies[0].mesh->cellType(), mesh::CellType::triangle6);
}

const std::string disk = R"(
lc = 0.5;
Point(1) = {0, 0, 0, lc}; Point(2) = {1, 0, 0, lc}; Point(3) = {0, 1, 0, lc};
Point(4) = {-1, 0, 0, lc}; Point(5) = {0, -1, 0, lc};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("disk") = {1};
Physical Curve("rim") = {1, 2, 3, 4};
)";

TEST_F(RefinableMeshesTest, AGeometryIsMeshedAnewWithNodesOnIt) {
  RefinableMeshes meshes(membraneOn(geometry("disk.geo", disk), {"disk"}), *comm);
  std::size_t before = 0;
  double missing = 1; // of the disk
  for (int round = 0; round < 3; ++round) {
    const auto curved = bodiesOf(meshes, 2), straight = bodiesOf(meshes, 1);
    const mesh::Surface rim = curved[0].mesh->surface("rim");
    EXPECT_EQ(rim.facetType, mesh::CellType::line3);
    for (const GlobalOrdinal node : rim.facetNodes)
      EXPECT_NEAR(distance(curved[0].mesh->point(node), {0, 0, 0}), 1, 1e-9);
    const Values measures = meshes.measures()[0];
    EXPECT_NEAR(sumOf(measures), measureOf(*straight[0].mesh), roundOff);
    EXPECT_LT(std::numbers::pi - sumOf(measures), missing);
    EXPECT_NEAR(measureOf(*curved[0].mesh), std::numbers::pi, 0.1 * (std::numbers::pi - sumOf(measures)));
    if (round > 0) { // a halving makes four of one, about
      const double growth = static_cast<double>(measures.size()) / static_cast<double>(before);
      EXPECT_GT(growth, 2);
      EXPECT_LT(growth, 8);
    }
    missing = 0.6 * (std::numbers::pi - sumOf(measures));
    before = measures.size();
    meshes.refine(halvings(meshes, everywhereOnce), *comm);
  }
}

TEST_F(RefinableMeshesTest, ANewElementLiesInTheOneThatIsItsAncestor) {
  RefinableMeshes meshes(membraneOn(geometry("disk.geo", disk), {"disk"}), *comm);
  const auto old = elementsOf(*bodiesOf(meshes)[0].mesh);
  const std::vector<Ancestors> ancestors = meshes.refine(halvings(meshes, everywhereOnce), *comm);
  const auto young = elementsOf(*bodiesOf(meshes)[0].mesh);
  ASSERT_EQ(ancestors[0].size(), young.size());
  std::set<LocalOrdinal> parents;
  for (std::size_t e = 0; e < young.size(); ++e) {
    const std::vector<Point>& ancestor = old.at(ancestors[0][e]);
    const Point centre = mesh::centreOf(young[e]);
    EXPECT_LT(distance(centre, mesh::centreOf(ancestor)), mesh::diameterOf(ancestor));
    parents.insert(ancestors[0][e]);
  }
  EXPECT_GT(static_cast<double>(parents.size()), 0.9 * static_cast<double>(old.size()));
}

TEST_F(RefinableMeshesTest, AGeometryGetsFinerWhereThatIsWantedAndCoarserElsewhere) {
  RefinableMeshes meshes(membraneOn(geometry("disk.geo", disk), {"disk"}), *comm);
  meshes.refine(halvings(meshes, everywhereOnce), *comm);
  const auto areaOn = [&](double side) { // mean area of the elements there
    double sum = 0, number = 0;
    for (const std::vector<Point>& element : elementsOf(*bodiesOf(meshes)[0].mesh))
      if (side * mesh::centreOf(element)[0] > 0.5) {
        sum += mesh::measureOf(mesh::CellType::triangle, element);
        ++number;
      }
    return sum / number;
  };
  const double left = areaOn(-1), right = areaOn(1);
  meshes.refine(halvings(meshes, [](const Point& x) { return x[0] > 0 ? 1.0 : -1.0; }), *comm);
  EXPECT_LT(areaOn(1), 0.5 * right);
  EXPECT_GT(areaOn(-1), 1.5 * left);
}

TEST_F(RefinableMeshesTest, BodiesOfOneGeometryHaveTheSizesThatEachOfThemWants) {
  RefinableMeshes meshes(membraneOn(geometry("two.geo", R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {2, 0, 0, 1, 1};
Mesh.MeshSizeMax = 0.25;
Physical Surface("west") = {1};
Physical Surface("east") = {2};
)"),
                                    {"west", "east"}),
                         *comm);
  const auto before = meshes.measures();
  const std::vector<Ancestors> ancestors =
      meshes.refine(halvings(meshes, [](const Point& x) { return x[0] < 1.5 ? 1.0 : 0.0; }), *comm);
  const auto after = meshes.measures();
  EXPECT_GT(after[0].size(), 2 * before[0].size());
  EXPECT_LT(after[1].size(), 2 * before[1].size());
  for (const std::size_t b : {0U, 1U}) {
    EXPECT_NEAR(sumOf(after[b]), 1, roundOff);
    ASSERT_EQ(ancestors[b].size(), after[b].size());
    EXPECT_LT(*std::max_element(ancestors[b].begin(), ancestors[b].end()),
              static_cast<LocalOrdinal>(before[b].size()));
  }
}

/// On the parabolas of its first mesh, not on its circles: nothing is added or cut off.
TEST_F(RefinableMeshesTest, AGeometryInRowsOfQuadrilateralsIsBisected) {
  RefinableMeshes meshes(membraneOn(geometry("ring.geo", R"(
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 2, 0}; Point(5) = {0, 1, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Transfinite Curve {1, 3} = 3;
Transfinite Curve {2, 4} = 5;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("ring") = {1};
Physical Curve("outer") = {2};
)"),
                                    {"ring"}),
                         *comm);
  const double first = measureOf(*bodiesOf(meshes, 2)[0].mesh);
  EXPECT_NEAR(first, 0.75 * std::numbers::pi, 1e-3);
  EXPECT_EQ(meshes.measures()[0].size(), 16U);
  for (int round = 0; round < 2; ++round) {
    const std::vector<Ancestors> ancestors = meshes.refine(halvings(meshes, everywhereOnce), *comm);
    const auto bodies = bodiesOf(meshes, 2);
    EXPECT_GE(ancestors[0].size(), std::size_t{64} << static_cast<unsigned>(2 * round));
    EXPECT_EQ(ancestors[0].size(), static_cast<std::size_t>(bodies[0].mesh->numElements()));
    EXPECT_NEAR(measureOf(*bodies[0].mesh), first, roundOff);
    for (const GlobalOrdinal node : bodies[0].mesh->surface("outer").facetNodes)
      EXPECT_NEAR(distance(bodies[0].mesh->point(node), {0, 0, 0}), 2, 1e-3);
  }
}

/// Its shape is a mesh, without which there is nothing that could be meshed anew.
TEST_F(RefinableMeshesTest, AGeometryThatMergesAMeshIsBisected) {
  (void)geometry("base.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
2
1 2 2 7 1 1 2 3
2 2 2 7 1 1 3 4
$EndElements
)");
  RefinableMeshes meshes(
      membraneOn(geometry("merged.geo", "Merge \"base.msh\";\nPhysical Surface(\"plate\") = {1};\n"),
                 {"plate"}),
      *comm);
  const std::vector<Ancestors> ancestors = meshes.refine(halvings(meshes, everywhereOnce), *comm);
  EXPECT_EQ(ancestors[0].size(), 8U);
  EXPECT_NEAR(measureOf(*bodiesOf(meshes, 1)[0].mesh), 1, roundOff);
  EXPECT_FALSE(meshes.areRemeshed());
}

TEST_F(RefinableMeshesTest, AllRanksAreToldOfAFileThatCannotBeMeshed) {
  const std::string bad = geometry("bad.geo", "Point(1) = {0, 0, 0};\nLine(1) = {1, 2};\n");
  for (const std::string& file : {bad, std::string("none.geo"), std::string("none.msh")})
    epafi::test::expectSays(
        epafi::test::refusal([&] { const RefinableMeshes meshes(membraneOn(file, {"disk"}), *comm); }),
        {file});
}

} // namespace
} // namespace epafi::accuracy
