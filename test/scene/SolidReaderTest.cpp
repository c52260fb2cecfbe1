#include "SceneLists.hpp"

#include <cmath>
#include <functional>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

TEST(SolidReaderTest, ReadsMeshAndMaterialOfABodyInSpace) {
  const scene::Body solid = solidOf(cubeOnFloor());
  EXPECT_EQ(solid.physics, fem::Physics::elasticity3d);
  EXPECT_EQ(solid.mesh.elements, (std::array<int, 3>{2, 2, 2}));
  EXPECT_EQ(solid.mesh.box.upper[2], 1.0);
  EXPECT_EQ(solid.material.youngsModulus, 200.0);
  EXPECT_EQ(solid.material.poissonsRatio, 0.3);
}

TEST(SolidReaderTest, ReadsBodiesInThePlaneWithThickness) {
  for (const auto& [word, physics] : {std::pair("plane strain", fem::Physics::planeStrain),
                                      std::pair("plane stress", fem::Physics::planeStress)}) {
    ParameterList list;
    ParameterList& plate = bodyOf(list, "plate");
    plate.set("Physics", word).set("Rectangle", numbers({0, 4, 0, 2})).set("Elements", counts({4, 2}));
    plate.set("Young's Modulus", 1.0).set("Poisson's Ratio", 0.0).set("Thickness", 5.0);
    const scene::Body solid = solidOf(list);
    EXPECT_EQ(solid.physics, physics);
    EXPECT_EQ(solid.material.thickness, 5.0);
    EXPECT_EQ(solid.mesh.elements, (std::array<int, 3>{4, 2, 0}));
  }
}

/// A cylinder on a ball.
ParameterList cylinderOnBall() {
  ParameterList list("Epafi");
  ParameterList& body = bodyOf(list, "cylinder");
  body.set("Physics", "axisymmetric").set("Rectangle", numbers({0, 1, 0, 2})).set("Elements", counts({2, 4}));
  body.set("Young's Modulus", 200.0).set("Poisson's Ratio", 0.3);
  body.sublist("Loads").sublist("turn").set("Kind", "rotation").set("Value", 3.0);
  list.sublist("Obstacles").sublist("ball").set("Kind", "circle").set("Point", numbers({0, -3}));
  list.sublist("Obstacles").sublist("ball").set("Radius", 3.0);
  ParameterList& pair = list.sublist("Contact").sublist("rest");
  pair.set("First Body", "cylinder").set("First Surface", "bottom").set("Obstacle", "ball");
  return list;
}

TEST(SolidReaderTest, ReadsSolidsOfRevolution) {
  const scene::Body solid = solidOf(cylinderOnBall());
  EXPECT_EQ(solid.physics, fem::Physics::axisymmetric);
  EXPECT_TRUE(solid.holdsAxis);
  ParameterList loose = cylinderOnBall();
  bodyOf(loose, "cylinder").set("Axis", "free");
  EXPECT_FALSE(solidOf(loose).holdsAxis);
  expectSays(cubeRefusal("Axis", "free"), {"\"Axis\"", "axisymmetric"});
  EXPECT_EQ(solid.loads.at(0).axis, (Vector3{0, 1, 0}));
  EXPECT_EQ(solid.loads.at(0).point, (Vector3{0, 0, 0}));
}

TEST(SolidReaderTest, RefusesWhatIsNotSymmetricAboutTheAxis) {
  const auto refused = [](const auto& change) {
    ParameterList list = cylinderOnBall();
    change(list, bodyOf(list, "cylinder"));
    return refusal([&] { scene::readScene(list, "scenes/a.xml"); });
  };
  const auto ball = [](ParameterList& list) -> ParameterList& {
    return list.sublist("Obstacles").sublist("ball");
  };
  expectSays(refused([](ParameterList&, ParameterList& body) { body.set("Thickness", 2.0); }),
             {"\"Thickness\"", "axisymmetric"});
  expectSays(refused([](ParameterList&, ParameterList& body) {
               body.sublist("Loads").sublist("turn").set("Point", numbers({1, 0}));
             }),
             {"\"Point\"", "turns about its axis"});
  expectSays(refused([&](ParameterList& list, ParameterList&) {
               ball(list).set("Point", numbers({1, -3}));
             }),
             {"\"Obstacle\"", "axisymmetric", "x = 0"});
  expectSays(refused([&](ParameterList& list, ParameterList&) {
               ball(list).remove("Radius");
               ball(list).set("Kind", "plane").set("Normal", numbers({1, 1}));
             }),
             {"\"Obstacle\"", "axisymmetric", "{0, 1}"});
  expectSays(refused([](ParameterList&, ParameterList& body) {
               body.remove("Young's Modulus");
               body.remove("Poisson's Ratio");
               body.set("Elasticity", numbers({4, 0.1, 2, 0.2, 0.3, 3, 5, 6, 7}));
               body.set("Axes", numbers({1, 0, 0, 0, 1, 1}));
             }),
             {"\"Elasticity\"", "would twist"});
}

TEST(SolidReaderTest, FindsMeshFilesBesideTheScene) {
  ParameterList list = cubeOnFloor();
  ParameterList& cube = bodyOf(list, "cube");
  cube.remove("Box");
  cube.remove("Elements");
  cube.set("Mesh", "parts/cube.geo")
      .set("Group", "cube")
      .set("Mesh Size Factor", 0.5)
      .set("Mesh Refinements", 2);
  const scene::Scene scene = scene::readScene(list, "scenes/a.xml");
  EXPECT_EQ(scene.bodies[0].mesh.file, "scenes/parts/cube.geo");
  EXPECT_EQ(scene.bodies[0].mesh.group, "cube");
  EXPECT_EQ(scene.bodies[0].mesh.sizeFactor, 0.5);
  EXPECT_EQ(scene.bodies[0].mesh.refinements, 2);
  EXPECT_EQ(scene.bodies[0].decomposition.method, scene::Decomposition::Method::metis)
      << "a mesh file has no grid";
  cube.set("Mesh", "/parts/cube.geo");
  EXPECT_EQ(solidOf(list).mesh.file, "/parts/cube.geo");
}

TEST(SolidReaderTest, ReadsWhatBecomesOfInnerNodesAndByHowManyPointsIsIntegrated) {
  ParameterList list = cubeOnFloor();
  ParameterList& cube = bodyOf(list, "cube");
  EXPECT_FALSE(solidOf(list).reducedIntegration);
  cube.remove("Box");
  cube.remove("Elements");
  cube.set("Mesh", "cube.msh");
  EXPECT_EQ(solidOf(list).mesh.innerNodes, mesh::InnerNodes::added);
  cube.set("Inner Nodes", "none").set("Integration", "reduced");
  EXPECT_EQ(solidOf(list).mesh.innerNodes, mesh::InnerNodes::none);
  EXPECT_TRUE(solidOf(list).reducedIntegration);
  expectSays(cubeRefusal("Inner Nodes", "none"), {"\"Inner Nodes\"", "no mesh file"});
}

/// Twice as stiff along a = (0, 1, 0) as across.
TEST(SolidReaderTest, ReadsElasticConstantsInTheirAxes) {
  ParameterList list = cubeOnFloor();
  ParameterList& cube = bodyOf(list, "cube");
  cube.remove("Young's Modulus");
  cube.remove("Poisson's Ratio");
  cube.set("Elasticity", numbers({4, 0.1, 2, 0.2, 0.3, 3, 5, 6, 7})).set("Axes", numbers({0, 2, 0, 0, 5, 1}));
  const fem::Material made = solidOf(list).material;
  ASSERT_TRUE(made.elasticity);
  const auto& c = *made.elasticity; // axes 1, 2, 3 are y, z, x
  EXPECT_NEAR(c(1, 1), 4, 1e-14);
  EXPECT_NEAR(c(2, 2), 2, 1e-14);
  EXPECT_NEAR(c(0, 0), 3, 1e-14);
  EXPECT_NEAR(c(1, 2), 0.1, 1e-14);
  EXPECT_NEAR(c(1, 0), 0.2, 1e-14);
  EXPECT_NEAR(c(2, 0), 0.3, 1e-14);
  EXPECT_NEAR(c(4, 4), 5, 1e-14); // 12 is yz
  EXPECT_NEAR(c(3, 3), 6, 1e-14); // 13 is yx
  EXPECT_NEAR(c(5, 5), 7, 1e-14); // 23 is zx
  ParameterList& region = cube.sublist("Regions").sublist("steel");
  region.set("Box", numbers({0, 0.5, 0, 1, 0, 1})).set("Young's Modulus", 210.0).set("Poisson's Ratio", 0.3);
  EXPECT_FALSE(solidOf(list).regions.at(0).material.elasticity);
}

TEST(SolidReaderTest, RefusesElasticConstantsThatAreNone) {
  const auto refused = [](const std::function<void(ParameterList&)>& change) {
    return solidRefusal([&](ParameterList& list) {
      ParameterList& cube = bodyOf(list, "cube");
      cube.remove("Young's Modulus");
      cube.remove("Poisson's Ratio");
      cube.set("Elasticity", numbers({4, 0.1, 2, 0.2, 0.3, 3, 5, 6, 7}));
      change(cube);
    });
  };
  expectSays(cubeRefusal("Elasticity", numbers({4, 0.1, 2, 0.2, 0.3, 3, 5, 6, 7})),
             {"\"Young's Modulus\"", "\"Elasticity\""});
  expectSays(cubeRefusal("Axes", numbers({1, 0, 0, 0, 1, 0})), {"\"Axes\"", "\"Elasticity\""});
  expectSays(refused([](ParameterList& cube) {
               cube.set("Elasticity", numbers({1, 2, 3}));
             }),
             {"\"Elasticity\"", "9", "21", "not 3"});
  expectSays(refused([](ParameterList& cube) {
               cube.set("Elasticity", numbers({1, 2, 1, 0, 0, 1, 1, 1, 1}));
             }),
             {"\"Elasticity\"", "positive definite"});
  expectSays(refused([](ParameterList& cube) {
               cube.set("Axes", numbers({1, 0, 0, -2, 0, 0}));
             }),
             {"\"Axes\"", "in one line"});
  expectSays(refused([](ParameterList& cube) { cube.set("Axes", numbers({1, 0, 0})); }), {"\"Axes\"", "6"});
  expectSays(refused([](ParameterList& cube) {
               ParameterList& region = cube.sublist("Regions").sublist("steel");
               region.set("Box", numbers({0, 0.5, 0, 1, 0, 1})).set("Young's Modulus", 210.0);
             }),
             {"\"Poisson's Ratio\"", "must be given"});
}

TEST(SolidReaderTest, ReadsAMembraneOnAMeshFile) {
  ParameterList list;
  ParameterList& body = bodyOf(list, "skin");
  body.set("Mesh", "skin.msh").set("Conductivity", 3.0);
  body.sublist("Supports").sublist("rim").set("Surface", "rim").set("Value", 0.5);
  body.sublist("Loads").sublist("wind").set("Value", -2.0);
  const scene::Body solid = solidOf(list);
  EXPECT_EQ(solid.physics, fem::Physics::membrane);
  EXPECT_EQ(solid.material.conductivity, 3.0);
  EXPECT_EQ(solid.supports.at(0).value[0], 0.5);
  EXPECT_EQ(solid.loads.at(0).value[0], -2.0);
}

TEST(SolidReaderTest, ARegionKeepsWhatItDoesNotChange) {
  ParameterList list = cubeOnFloor();
  bodyOf(list, "cube")
      .sublist("Regions")
      .sublist("soft")
      .set("Box", numbers({0, 1, 0, 1, 0, 0.5}))
      .set("Young's Modulus", 2.0);
  const fem::SolidRegion region = solidOf(list).regions.at(0);
  EXPECT_EQ(region.material.youngsModulus, 2.0);
  EXPECT_EQ(region.material.poissonsRatio, 0.3);
  EXPECT_EQ(region.box.upper[2], 0.5);
}

TEST(SolidReaderTest, CutsABoxInThreeDirections) {
  EXPECT_EQ(scene::readScene(cubeOnFloor(), "a.xml").bodies[0].decomposition.counts,
            (std::array<int, 3>{2, 2, 2}));
  ParameterList list = cubeOnFloor();
  bodyOf(list, "cube").set("Elements", counts({1, 4, 4}));
  EXPECT_EQ(scene::readScene(list, "a.xml").bodies[0].decomposition.counts, (std::array<int, 3>{1, 2, 2}))
      << "a default is no more than the elements allow";
  list.sublist("Decomposition").set("Grid", counts({1, 4, 2}));
  EXPECT_EQ(scene::readScene(list, "a.xml").bodies[0].decomposition.counts, (std::array<int, 3>{1, 4, 2}));
  list.sublist("Decomposition").set("Grid", counts({2, 2}));
  expectSays(refusal([&] { scene::readScene(list, "a.xml"); }),
             {"\"Grid\"", "3 entries {nx, ny, nz}, not 2"});
}

TEST(SolidReaderTest, RefusesABodyWithoutMeshOrMaterial) {
  for (const char* const name : {"Box", "Elements", "Young's Modulus", "Poisson's Ratio"})
    expectSays(solidRefusal([&](ParameterList& list) { bodyOf(list, "cube").remove(name); }),
               {"scenes/a.xml: ", "\"Bodies/cube\"", '"' + std::string(name) + '"', "must be given"});
}

TEST(SolidReaderTest, RefusesWhatThePhysicsHasNoUseFor) {
  expectSays(cubeRefusal("Conductivity", 2.0), {"\"Conductivity\"", "elasticity 3-D", "remove it"});
  expectSays(cubeRefusal("Thickness", 2.0), {"\"Thickness\"", "elasticity 3-D", "remove it"});
  expectSays(cubeRefusal("Rectangle", numbers({0, 1, 0, 1})), {"\"Rectangle\"", "has a \"Box\""});
  expectSays(cubeRefusal("Group", "cube"), {"\"Group\"", "no mesh file"});
  expectSays(cubeRefusal("Mesh", "a.msh"), {"\"Box\"", "mesh file", "remove one"});
  for (const char* const name : {"Young's Modulus", "Thickness"})
    expectSays(sceneRefusal([&](ParameterList& list) { bodyOf(list, "right").set(name, 2.0); }),
               {"\"Bodies/right\"", '"' + std::string(name) + '"', "membranes have none"});
}

TEST(SolidReaderTest, RefusesPoissonsRatiosThatNoMaterialHas) {
  for (const double ratio : {0.5, 0.7, -1.0})
    expectSays(cubeRefusal("Poisson's Ratio", ratio), {"\"Poisson's Ratio\"", "> -1", "< 0.5"});
}

TEST(SolidReaderTest, RefusesAMeshSizeForAMeshThatIsThere) {
  ParameterList list = cubeOnFloor();
  ParameterList& cube = bodyOf(list, "cube");
  cube.remove("Box");
  cube.remove("Elements");
  cube.set("Mesh", "cube.msh").set("Mesh Size Factor", 0.5);
  expectSays(refusal([&] { scene::readScene(list, "a.xml"); }), {"\"Mesh Size Factor\"", ".geo"});
}

TEST(SolidReaderTest, MeshesInSeveralFilesAreThoseOfGmshAndNotRefined) {
  EXPECT_TRUE(meshing::isSplit("meshes/press_*.msh"));
  EXPECT_TRUE(meshing::isSplit("press_*.msh"));
  EXPECT_FALSE(meshing::isSplit("a*b/press.msh"));
  ParameterList list = cubeOnFloor();
  ParameterList& cube = bodyOf(list, "cube");
  cube.remove("Box");
  cube.remove("Elements");
  cube.set("Mesh", "cube_*.geo");
  expectSays(refusal([&] { scene::readScene(list, "a.xml"); }), {"\"Mesh\"", "must end in .msh"});
  cube.set("Mesh", "cube_*_*.msh");
  expectSays(refusal([&] { scene::readScene(list, "a.xml"); }), {"\"Mesh\"", "one *"});
  cube.set("Mesh", "cube_*.msh").set("Mesh Refinements", 1);
  expectSays(refusal([&] { scene::readScene(list, "a.xml"); }), {"\"Mesh Refinements\"", "read as it is"});
}

TEST(SolidReaderTest, ElementsAreOfOrderOneOrTwo) {
  ParameterList list = cubeOnFloor();
  ParameterList& cube = bodyOf(list, "cube");
  EXPECT_EQ(scene::readScene(list, "a.xml").bodies[0].mesh.order, 2);
  cube.set("Order", 1);
  EXPECT_EQ(scene::readScene(list, "a.xml").bodies[0].mesh.order, 1);
  cube.set("Order", 3);
  expectSays(refusal([&] { scene::readScene(list, "a.xml"); }), {"\"Order\"", "2"});
  cube.remove("Box");
  cube.remove("Elements");
  cube.remove("Order");
  cube.set("Mesh", "cube.msh");
  EXPECT_EQ(scene::readScene(list, "a.xml").bodies[0].mesh.order, 0); // the file's own
  cube.set("Mesh", "cube.geo");
  EXPECT_EQ(scene::readScene(list, "a.xml").bodies[0].mesh.order, 2); // Gmsh makes what is asked for
}

TEST(SolidReaderTest, RefusesRegionsWithoutPlace) {
  expectSays(entryRefusal("Regions", [](ParameterList& r) { r.set("Young's Modulus", 2.0); }),
             {"\"Bodies/cube/Regions/new\"", "\"Box\"", "must be given"});
  expectSays(
      entryRefusal("Regions", [](ParameterList& r) { r.set("Group", "soft").set("Young's Modulus", 2.0); }),
      {"\"Group\"", "no mesh file"});
}

TEST(SolidReaderTest, ATiedJointGivesWayAlongAsAcrossUnlessItSays) {
  ParameterList list = cubeOnFloor();
  bodyOf(list, "other") = bodyOf(list, "cube");
  ParameterList& tie = list.sublist("Contact").sublist("tie");
  tie.set("Kind", "tied").set("First Body", "cube").set("First Surface", "top");
  tie.set("Second Body", "other").set("Second Surface", "bottom").set("Stick Slope", 3.0);
  const auto says = [&] { return refusal([&] { scene::readScene(list, "a.xml"); }); };
  expectSays(says(), {"\"Stick Slope\"", "needs a Stiffness"});
  tie.set("Stiffness", 8.0);
  EXPECT_EQ(scene::readScene(list, "a.xml").contacts.at(1).stickSlope, 3);
  tie.remove("Stick Slope");
  EXPECT_EQ(scene::readScene(list, "a.xml").contacts.at(1).stickSlope, 8);
  tie.set("Preload", "force 2");
  expectSays(says(), {"\"Preload\"", "does not give way"});
  tie.remove("Preload");
  tie.set("Coupling", "nodes");
  expectSays(says(), {"\"Coupling\"", "by mortars"});
}

} // namespace
