// Meshes that bodies on rectangles and boxes begin with: lines where the scene needs them, surfaces that
// match.

#include "epafi/accuracy/FirstGrid.hpp"

#include "RefinementSamples.hpp"

#include "epafi/mesh/UnstructuredMesh.hpp"

#include <algorithm>

namespace epafi::accuracy {
namespace {

using test::distance;
using test::elementsOf;
using test::measureOf;
using test::roundOff;
using test::sumOf;
using FirstGridTest = test::RefinementTest;

/// A membrane on (0, 2) × (0, 1) with a load, another material and a load at a point.
scene::Scene loadedMembrane() {
  scene::Scene scene = test::membrane(4, 2);
  scene::Body& body = scene.bodies[0];
  body.loads.push_back(fem::loadInside("load", mesh::rectangle(0.3, 1.1, -1, 0.7), -1));
  body.loads.push_back({"point", fem::SolidLoad::Kind::point, {}, "", {1.9, 0.45, 0}, {1, 0, 0}});
  body.regions.push_back({"stiff", mesh::rectangle(1.25, 2, 0, 1), "", {100}});
  return scene;
}

/// A narrow block on a wide one, of elements as different as may be.
scene::Scene blocks(fem::Physics physics) {
  const bool isPlane = dimensionOf(physics) == 2;
  scene::Scene scene;
  scene.bodies.resize(2);
  scene::Body &lower = scene.bodies[0], &upper = scene.bodies[1];
  lower.name = "lower";
  upper.name = "upper";
  lower.physics = upper.physics = physics;
  lower.mesh.box = isPlane ? mesh::Box{{0, 0, 0}, {3, 1, 0}} : mesh::Box{{0, 0, 0}, {3, 2, 1}};
  upper.mesh.box =
      isPlane ? mesh::Box{{0.7, 1, 0}, {2.2, 1.4, 0}} : mesh::Box{{0.7, -0.5, 1}, {2.2, 1.1, 1.4}};
  lower.mesh.elements = isPlane ? std::array{2, 1, 0} : std::array{2, 2, 1};
  upper.mesh.elements = isPlane ? std::array{7, 3, 0} : std::array{5, 3, 2};
  scene.contacts = {{"joint", 0, "top", 1, "bottom"}};
  return scene;
}

/// Whether no element has corners on both sides.
bool isLine(const mesh::Mesh& mesh, std::size_t axis, double place) {
  for (const std::vector<Point>& element : elementsOf(mesh)) {
    const auto [lower, upper] = mesh::boxOf(element);
    if (lower[axis] < place - roundOff && upper[axis] > place + roundOff)
      return false;
  }
  return true;
}

TEST_F(FirstGridTest, FirstMeshesHaveLinesWhereTheSceneNeedsThemAlsoOnceRefined) {
  RefinableMeshes meshes(loadedMembrane(), *comm);
  for (int round = 0; round < 3; ++round) {
    const auto bodies = bodiesOf(meshes);
    const mesh::Mesh& mesh = *bodies[0].mesh;
    for (const double place : {0.3, 1.1, 1.25, 1.9})
      EXPECT_TRUE(isLine(mesh, 0, place)) << "x = " << place;
    for (const double place : {0.45, 0.7})
      EXPECT_TRUE(isLine(mesh, 1, place)) << "y = " << place;
    double nearest = 1;
    for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
      nearest = std::min(nearest, distance(mesh.point(node), {1.9, 0.45, 0}));
    EXPECT_LT(nearest, roundOff);
    EXPECT_NEAR(sumOf(meshes.measures()[0]), 2, roundOff);
    EXPECT_NEAR(measureOf(mesh), 2, roundOff);
    meshes.refine(halvings(meshes, [](const Point& x) { return x[0] > 1 ? 0.5 : 0.0; }), *comm);
  }
}

TEST_F(FirstGridTest, ElementsOfTheFirstMeshAreNoLongerThanHalfTheBodyOrThoseOfTheScene) {
  for (const int elements : {1, 8}) {
    scene::Scene scene = loadedMembrane();
    scene.bodies[0].mesh.elements = {elements, 1, 0};
    const mesh::UnstructuredMesh mesh(arraysOf(firstGrid(scene, 0), 1));
    for (const std::vector<Point>& element : elementsOf(mesh)) {
      const auto [lower, upper] = mesh::boxOf(element);
      EXPECT_LE(upper[0] - lower[0], std::max(0.5, 2.0 / elements) + roundOff);
      EXPECT_LE(upper[1] - lower[1], 1 + roundOff);
    }
  }
  const mesh::SimplexMesh plain =
      firstGrid(test::membrane(9, 2), 0); // 4 × 2 squares, whatever the scene's own
  EXPECT_EQ(plain.elements.size(), 16U);
}

/// All facets of the one that lie within the other, by their centres.
std::vector<Point> centresWithin(const mesh::Mesh& mesh, const std::string& surface, const mesh::Box& box) {
  std::vector<Point> centres, points;
  const mesh::Surface facets = mesh.surface(surface);
  for (std::size_t f = 0; f < facets.numFacets(); ++f) {
    mesh.pointsAt(facets.facet(f), points);
    const Point centre = mesh::centreOf(points);
    bool isWithin = true;
    for (std::size_t d = 0; d < 3; ++d)
      isWithin = isWithin && centre[d] >= box.lower[d] - roundOff && centre[d] <= box.upper[d] + roundOff;
    if (isWithin)
      centres.push_back(centre);
  }
  return centres;
}

TEST_F(FirstGridTest, SurfacesThatTouchMatchAtFirst) {
  for (const fem::Physics physics : {fem::Physics::planeStrain, fem::Physics::elasticity3d}) {
    scene::Scene scene = blocks(physics);
    scene.bodies[1].loads.push_back(
        {"load", fem::SolidLoad::Kind::body, {{1, -9, -9}, {1.3, 9, 9}}, "", {0, 0, 0}, {1, 0, 0}});
    const RefinableMeshes meshes(scene, *comm);
    const auto bodies = bodiesOf(meshes);
    for (const double place : {0.7, 1.0, 1.3, 2.2})
      EXPECT_TRUE(isLine(*bodies[0].mesh, 0, place)) << "x = " << place;
    const std::vector<Point> below = centresWithin(*bodies[0].mesh, "top", scene.bodies[1].mesh.box),
                             above = centresWithin(*bodies[1].mesh, "bottom", scene.bodies[0].mesh.box);
    EXPECT_EQ(below.size(), above.size());
    EXPECT_GT(below.size(), 3U);
    for (const Point& centre : below)
      EXPECT_TRUE(std::any_of(above.begin(), above.end(),
                              [&](const Point& other) { return distance(centre, other) < roundOff; }))
          << centre[0] << ' ' << centre[1];
  }
}

} // namespace
} // namespace epafi::accuracy
