// Meshes that no rank holds whole: subdomains, contact and output are those of meshes that every rank holds.

#include "support/Gathered.hpp"
#include "support/MeshFiles.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <gtest/gtest.h>

namespace epafi::decomposition {
namespace {

using epafi::test::MeshFolder;
using model::Meshes;

/// A round lower body and a box on it, meshed apart, of two materials where wanted.
std::string roundAndBox() {
  return R"(SetFactory("OpenCASCADE");
Mesh.CharacteristicLengthMax = 0.35;
Cylinder(1) = {0, 0, 0, 0, 0, 1, 0.8};
Box(2) = {-0.5, -0.5, 1, 1, 1, 0.7};
Physical Volume("lower") = {1}; Physical Volume("upper") = {2};
Physical Surface("side") = {1}; Physical Surface("joint") = {2}; Physical Surface("bottom") = {3};
Physical Surface("foot") = {8}; Physical Surface("lid") = {9};
Physical Curve("rim") = {3}; Physical Point("tip") = {10};
)";
}

scene::Body body(const std::string& name, const MeshFolder& folder, int parts, int order) {
  scene::Body body;
  body.name = name;
  body.physics = fem::Physics::elasticity3d;
  body.material.youngsModulus = name == "lower" ? 200 : 70;
  body.mesh.file = folder.path("bodies.geo");
  body.mesh.group = name;
  body.mesh.order = order;
  body.decomposition.method = scene::Decomposition::Method::metis;
  body.decomposition.parts = parts;
  return body;
}

/// Round supports along their normals, a region, body forces, pressure and a force at a corner; a joint by
/// mortars.
scene::Scene sceneOf(const MeshFolder& folder, int order, scene::SurfaceContact::Kind kind) {
  (void)folder.write("bodies.geo", roundAndBox());
  scene::Scene scene;
  scene.bodies = {body("lower", folder, 5, order), body("upper", folder, 4, order)};
  scene::Body &lower = scene.bodies[0], &upper = scene.bodies[1];
  lower.supports = {{"floor", "bottom", {std::nullopt, std::nullopt, 0.0}}, {"wall", "side", {}, 0.0}};
  lower.supports.push_back({.name = "around",
                            .surface = "rim",
                            .value = {std::nullopt, 0.1, std::nullopt},
                            .axes = fem::LocalAxes{true, {0, 0, 0}, {0, 0, 1}}});
  lower.regions = {{"core", {{-1, -1, 0}, {0.1, 1, 1}}, "", {}}};
  lower.regions[0].material.youngsModulus = 500;
  using Kind = fem::SolidLoad::Kind;
  upper.loads = {{"press", Kind::pressure, {}, "lid", {}, {3, 0, 0}},
                 {"corner", Kind::point, {}, "", {0.5, 0.5, 1.7}, {0, 0.1, 0.2}},
                 {"pull", Kind::point, {}, "tip", {}, {1, 2, 3}},
                 {"turn", Kind::rotation, {}, "", {0.5, 0, 0}, {2, 0, 0}},
                 {"weight", Kind::body, {{-1, -1, 1.2}, {1, 0.2, 2}}, "", {}, {0, 0, -1}}};
  scene.contacts = {{"joint", 0, "joint", 1, "foot"}};
  scene.contacts[0].kind = kind;
  return scene;
}

void expectEqual(const Subdomain& a, const Subdomain& b) {
  EXPECT_TRUE(a.number == b.number);
  EXPECT_EQ(a.body, b.body);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.unknownPosition, b.unknownPosition);
  EXPECT_EQ(a.crosspointUnknowns, b.crosspointUnknowns);
  EXPECT_EQ((a.kernel - b.kernel).norm(), 0);
  EXPECT_EQ((Eigen::MatrixXd(*a.stiffness) - Eigen::MatrixXd(*b.stiffness)).cwiseAbs().maxCoeff(), 0);
  ASSERT_EQ(a.constraint.size(), b.constraint.size());
  for (std::size_t k = 0; k < a.constraint.size(); ++k) {
    EXPECT_TRUE(a.constraint[k].unknown == b.constraint[k].unknown);
    EXPECT_EQ(a.constraint[k].coefficient, b.constraint[k].coefficient);
  }
}

class MeshPiecesTest : public testing::TestWithParam<std::tuple<int, scene::SurfaceContact::Kind, int>> {
protected:
  MeshFolder folder_;
  scene::Scene scene_ = sceneOf(folder_, std::get<0>(GetParam()), std::get<1>(GetParam()));
};

TEST_P(MeshPiecesTest, GiveTheSubdomainsAndRowsOfWholeMeshes) {
  for (scene::Body& body : scene_.bodies)
    body.decomposition.cluster = std::get<2>(GetParam());
  const Decomposition whole = decompose(scene_, world()), pieces = decompose(scene_, world(), Meshes::pieces);
  for (std::size_t b = 0; b < 2; ++b)
    EXPECT_EQ(pieces.bodies[b].mesh->part() != nullptr, world()->getSize() > 1);
  ASSERT_EQ(pieces.problem.subdomains.size(), whole.problem.subdomains.size());
  for (std::size_t s = 0; s < whole.problem.subdomains.size(); ++s) {
    expectEqual(pieces.problem.subdomains[s], whole.problem.subdomains[s]);
    EXPECT_EQ(pieces.data.subdomains()[s].rightHandSide(), whole.data.subdomains()[s].rightHandSide());
    EXPECT_EQ(pieces.data.subdomains()[s].prescribed, whole.data.subdomains()[s].prescribed);
  }
  EXPECT_EQ(pieces.problem.kernelDimension, whole.problem.kernelDimension);
  EXPECT_EQ(pieces.problem.numCrosspoints, whole.problem.numCrosspoints);
  EXPECT_TRUE(pieces.problem.multiplierMap->isSameAs(*whole.problem.multiplierMap));
}

INSTANTIATE_TEST_SUITE_P(OrdersAndJoints, MeshPiecesTest,
                         testing::Values(std::tuple(1, scene::SurfaceContact::Kind::contact, 0),
                                         std::tuple(2, scene::SurfaceContact::Kind::contact, 2),
                                         std::tuple(2, scene::SurfaceContact::Kind::tied, 0)));

/// Hexahedra of 20 nodes, perhaps among others, integrated by fewer points.
scene::Scene bricks(const MeshFolder& folder, std::array<int, 3> elements, int parts,
                    epafi::test::Cut cut = epafi::test::Cut::none) {
  const mesh::StructuredMesh grid({{0, 0, 0}, {2, 3, 4}}, elements);
  const mesh::MeshArrays arrays =
      completed(epafi::test::arraysOf(grid, epafi::test::placed(3, 0.4, {0, 0, 0}), cut), false,
                mesh::InnerNodes::none);
  scene::Scene scene;
  scene.bodies = {body("lower", folder, parts, 0)};
  scene::Body& only = scene.bodies[0];
  only.mesh.file = folder.write("bricks.msh", epafi::test::fileOf(arrays));
  only.mesh.group = "body";
  only.mesh.innerNodes = mesh::InnerNodes::none;
  only.reducedIntegration = true;
  only.supports = {{"wall", "left", {0.0, 0.0, 0.0}}};
  only.loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "right", {}, {3, 0, 0}},
                {"lid", fem::SolidLoad::Kind::pressure, {}, "top", {}, {1, 0, 0}}};
  return scene;
}

TEST(BrickPiecesTest, AreTheSameWhereElementsOfTwentyNodesAreIntegratedByFewerPoints) {
  const MeshFolder folder;
  for (const auto& [parts, cut] : {std::pair(0, epafi::test::Cut::none),
                                   {3, epafi::test::Cut::none},
                                   {12, epafi::test::Cut::none},
                                   {60, epafi::test::Cut::none},
                                   {7, epafi::test::Cut::mixed}}) {
    const scene::Scene scene = bricks(folder, {3, 4, 5}, parts, cut);
    const Decomposition whole = decompose(scene, world()), pieces = decompose(scene, world(), Meshes::pieces);
    EXPECT_EQ(whole.bodies[0].mesh->cellType(), mesh::CellType::hexahedron20);
    EXPECT_EQ(pieces.bodies[0].mesh->cellType(), mesh::CellType::hexahedron20);
    ASSERT_EQ(pieces.problem.subdomains.size(), whole.problem.subdomains.size());
    for (std::size_t s = 0; s < whole.problem.subdomains.size(); ++s)
      expectEqual(pieces.problem.subdomains[s], whole.problem.subdomains[s]);
    const mesh::Surface lid = whole.bodies[0].mesh->surface("top"),
                        again = pieces.bodies[0].mesh->surface("top");
    EXPECT_EQ(lid.facetNodes, again.facetNodes);
    EXPECT_EQ(lid.elements, again.elements);
  }
}

TEST(BrickPiecesTest, RowsOfSuchElementsAreRefused) {
  const MeshFolder folder;
  for (const Meshes meshes : {Meshes::whole, Meshes::pieces})
    epafi::test::expectRefusal(
        [&] {
          decompose(bricks(folder, {1, 4, 1}, 2), world(), meshes);
        },
        {"'lower'", "loose", "along one axis"});
}

class RefusedPiecesTest : public testing::Test {
protected:
  MeshFolder folder_;
  scene::Scene scene_ = sceneOf(folder_, 1, scene::SurfaceContact::Kind::contact);

  /// In the words in which whole meshes are refused, on every rank.
  void expectRefusedAlike(const std::string& part) {
    const std::string words = epafi::test::refusal([&] { decompose(scene_, world()); });
    EXPECT_NE(words.find(part), std::string::npos) << words;
    epafi::test::expectRefusal([&] { decompose(scene_, world(), Meshes::pieces); }, {words});
  }
};

TEST_F(RefusedPiecesTest, RegionsThatMeetNoElementAreRefused) {
  scene_.bodies[0].regions[0].box = {{5, 5, 5}, {6, 6, 6}};
  expectRefusedAlike("no element has its centre in its box");
}

TEST_F(RefusedPiecesTest, PointsWithoutANodeAreRefused) {
  scene_.bodies[1].loads[1].point = {0.01, 0.02, 1.31};
  expectRefusedAlike("no node lies at the point");
}

TEST_F(RefusedPiecesTest, SurfacesThatAreNotThereAreRefused) {
  scene_.bodies[0].supports[0].surface = "ceiling";
  expectRefusedAlike("names the surface or set of nodes 'ceiling'");
}

TEST_F(RefusedPiecesTest, FilesThatAreNotThereAreRefused) {
  scene_.bodies[1].mesh.file = folder_.path("nothing.msh");
  expectRefusedAlike("nothing.msh");
}

TEST_F(RefusedPiecesTest, FilesThatAreCutOffAreRefused) {
  scene_.bodies[1].mesh.file =
      folder_.write("cut.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n");
  expectRefusedAlike("cut.msh");
}

TEST_F(RefusedPiecesTest, TooManyPartsAreRefused) {
  scene_.bodies[1].decomposition.parts = 1000000;
  expectRefusedAlike("cannot be cut into 1000000 parts");
}

} // namespace
} // namespace epafi::decomposition
