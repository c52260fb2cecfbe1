// Meshes that Gmsh has cut into files, and ranks read side by side: they are the meshes of one file, but for
// the parts.

#include "support/Gathered.hpp"
#include "support/MeshFiles.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/mesh/MeshPart.hpp"
#include "epafi/meshing/GmshFile.hpp"
#include "epafi/meshing/GmshReader.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <gtest/gtest.h>

#include <filesystem>

namespace epafi::decomposition {
namespace {

using epafi::test::MeshFolder;
using model::Meshes;

/// Two bodies that share a face.
constexpr const char* boxes = R"(SetFactory("OpenCASCADE");
Mesh.CharacteristicLengthMax = 0.3;
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 0.6, 1, 1};
Box(3) = {1.6, 0, 0, 0.6, 1, 1};
Coherence;
Physical Volume("left") = {1}; Physical Volume("right") = {2, 3};
Physical Surface("wall") = Surface In BoundingBox{-0.01, -1, -1, 0.01, 2, 2};
Physical Surface("joint") = Surface In BoundingBox{0.99, -1, -1, 1.01, 2, 2};
Physical Surface("top") = Surface In BoundingBox{-1, -1, 0.99, 3, 2, 1.01};
)";

/// All ranks have one folder.
class SplitFilesTest : public testing::TestWithParam<std::tuple<int, int, std::string>> {
protected:
  std::string path(const std::string& name) const { return folder() + '/' + name; }
  const std::string& folder() const { return folderOfFirst_; }

  /// A geometry, meshed and saved as whole.msh and as part_1.msh …
  void mesh(const std::string& geometry, int order, int files, const std::string& more) const {
    if (world()->getRank() == 0)
      (void)meshing::textOfMeshFile(own_.write(
          "bodies.geo", geometry + "Mesh 3; SetOrder " + std::to_string(order) + ";\n" + more + "Save \"" +
                            path("whole.msh") + "\";\nMesh.PartitionSplitMeshFiles = 1;\nPartitionMesh " +
                            std::to_string(files) + ";\nSave \"" + path("part.msh") + "\";\n"));
    world()->barrier();
  }

  static scene::Body body(const std::string& name, const std::string& file, const std::string& group) {
    scene::Body body;
    body.name = name;
    body.physics = fem::Physics::elasticity3d;
    body.material.youngsModulus = name == "left" ? 200 : 70;
    body.mesh.file = file;
    body.mesh.group = group;
    body.mesh.order = 0;
    body.decomposition.method = scene::Decomposition::Method::metis;
    body.decomposition.parts = 7;
    return body;
  }

  /// Bonded at the face that they share. \param file  "whole.msh" or "part_*.msh"
  scene::Scene sceneOf(const std::string& file) const {
    scene::Scene scene;
    scene.bodies = {body("left", path(file), "left"), body("right", path(file), "right")};
    scene.bodies[0].supports = {{"wall", "wall", {}, 0.0}};
    scene.bodies[1].regions = {{"end", {{1.6, -1, -1}, {3, 2, 2}}, "", {}}};
    scene.bodies[1].regions[0].material.youngsModulus = 500;
    using Kind = fem::SolidLoad::Kind;
    scene.bodies[1].loads = {{"press", Kind::pressure, {}, "top", {}, {3, 0, 0}},
                             {"corner", Kind::point, {}, "", {2.2, 1, 1}, {0, 0.1, 0.2}},
                             {"weight", Kind::body, {{1.2, -1, -1}, {3, 2, 2}}, "", {}, {0, 0, -1}}};
    scene.contacts = {{"joint", 0, "joint", 1, "joint"}};
    scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
    return scene;
  }

  void expectRefused(const scene::Scene& scene, const std::string& words) const {
    epafi::test::expectRefusal([&] { decompose(scene, world(), Meshes::pieces); }, {words});
  }
  /// Removes a file of rank 0's.
  void remove(const std::string& name) const {
    if (world()->getRank() == 0)
      std::filesystem::remove(path(name));
    world()->barrier();
  }
  void TearDown() override { world()->barrier(); } // before rank 0's folder goes

private:
  MeshFolder own_;
  std::string folderOfFirst_ = [this] {
    const std::vector<char> name =
        gatherOnAll(*world(), world()->getRank() == 0 ? own_.path(".") : std::string());
    return std::string(name.begin(), name.end());
  }();
};

/// Of each body: uᵀKu and fᵀu for a field u that nothing but the nodes' places tells, summed over the
/// elements of all ranks.
std::vector<double> works(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) {
  std::vector<double> sums;
  const model::Share share = shareOf(bodies, *world());
  Eigen::MatrixXd k;
  Eigen::VectorXd f;
  std::vector<Point> points;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    double energy = 0, work = 0;
    const auto model = makeModel(scene.bodies[b], *bodies[b].mesh);
    for (int part = 0; part < bodies[b].partition->numParts(); ++part) {
      if (const int number = bodies[b].firstSubdomain + part; number < share.begin || number >= share.end)
        continue;
      for (const GlobalOrdinal element : bodies[b].partition->elementsOf(part)) {
        model->element(element, k, f);
        bodies[b].mesh->elementPoints(element, points);
        Eigen::VectorXd u(k.rows());
        for (std::size_t i = 0; i < points.size(); ++i) {
          const auto& [x, y, z] = points[i];
          u.segment<3>(static_cast<Eigen::Index>(3 * i)) << x * y - z, std::sin(x + 2 * z), y * y + x;
        }
        energy += u.dot(k * u);
        work += u.dot(f);
      }
    }
    sums.insert(sums.end(), {energy, work});
  }
  sumOverRanks(*world(), std::span(sums));
  return sums;
}

TEST_P(SplitFilesTest, HoldTheMeshOfOneFile) {
  const auto [order, files, format] = GetParam();
  mesh(boxes, order, files, format);
  const scene::Scene scene = sceneOf("part_*.msh");
  const Decomposition split = decompose(scene, world(), Meshes::pieces);
  const meshing::GmshFile file(path("whole.msh"));
  for (std::size_t b = 0; b < 2; ++b) {
    const mesh::UnstructuredMesh whole = file.body(scene.bodies[b].mesh.group);
    const mesh::MeshPart& piece = *split.bodies[b].mesh->part();
    EXPECT_EQ(piece.numNodes(), whole.numNodes());
    EXPECT_EQ(piece.numElements(), whole.numElements());
    EXPECT_EQ(piece.cellType(), whole.cellType());
    EXPECT_GE(split.bodies[b].partition->numParts(), 4);
    for (const GlobalOrdinal node : piece.nodes()) {
      EXPECT_EQ(piece.point(node), whole.point(node));
      EXPECT_EQ(piece.isBoundaryNode(node), whole.isBoundaryNode(node));
    }
    std::vector<std::string> names = whole.surfaceNames();
    std::sort(names.begin(), names.end());
    ASSERT_EQ(piece.surfaceNames(), names); // "joint" is one of both bodies, wherever its elements went
    for (const std::string& name : names) {
      std::vector<GlobalOrdinal> a = piece.surface(name).facetNodes, c = whole.surface(name).facetNodes;
      std::sort(a.begin(), a.end());
      std::sort(c.begin(), c.end());
      EXPECT_EQ(a, c) << name;
    }
    EXPECT_EQ(piece.groupNames(), whole.groupNames());
  }
  const scene::Scene ofOneFile = sceneOf("whole.msh");
  const std::vector<double> a = works(scene, split.bodies),
                            b = works(ofOneFile, layoutBodies(ofOneFile, *world(), Meshes::pieces));
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a[i], b[i], 1e-12 * std::abs(b[0])) << i;
}

TEST_P(SplitFilesTest, GiveTheSameSubdomainsOnAnyNumberOfRanks) {
  const auto [order, files, format] = GetParam();
  mesh(boxes, order, files, format);
  scene::Scene scene = sceneOf("part_*.msh");
  scene.bodies[1].decomposition.cluster = 2;
  const Decomposition here = decompose(scene, world(), Meshes::pieces),
                      alone = decompose(scene, rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)), Meshes::pieces);
  for (std::size_t s = 0; s < here.problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = here.problem.subdomains[s];
    const Subdomain& same = alone.problem.subdomains[subdomain.number];
    EXPECT_EQ(here.data.subdomains()[s].load, alone.data.subdomains()[subdomain.number].load);
    EXPECT_EQ(subdomain.body, same.body);
    EXPECT_EQ(subdomain.nodes, same.nodes);
    EXPECT_EQ(Eigen::MatrixXd(*subdomain.stiffness), Eigen::MatrixXd(*same.stiffness));
  }
  EXPECT_EQ(here.problem.numCrosspoints, alone.problem.numCrosspoints);
  EXPECT_EQ(here.problem.kernelDimension, alone.problem.kernelDimension);
}

TEST_P(SplitFilesTest, StandBesideBodiesOfOneFileAndBoxes) {
  const auto [order, files, format] = GetParam();
  mesh(boxes, order, files, format);
  scene::Scene mixed = sceneOf("part_*.msh"), ofOneFile = sceneOf("whole.msh");
  mixed.bodies[1].mesh.file = path("whole.msh");
  for (scene::Scene* scene : {&mixed, &ofOneFile}) {
    scene::Body box = body("box", "", "");
    box.mesh.box = {{3, 0, 0}, {4, 1, 1}};
    box.mesh.elements = {2, 3, 4};
    box.mesh.order = order;
    scene->bodies.insert(scene->bodies.begin(), box);
    for (int* number : {&scene->contacts[0].first, &scene->contacts[0].second})
      ++*number;
  }
  const Decomposition all = decompose(mixed, world(), Meshes::pieces);
  const std::vector<double> a = works(mixed, all.bodies),
                            b = works(ofOneFile, layoutBodies(ofOneFile, *world(), Meshes::pieces));
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a[i], b[i], 1e-12 * std::abs(b[0])) << i;
}

constexpr const char* inText = "Mesh.MshFileVersion = 4.1; Mesh.Binary = 0;\n";
/// Format 2.2 has no elements in two groups.
constexpr const char* withGroup =
    "Mesh.MshFileVersion = 4.1; Mesh.Binary = 1; Physical Volume(\"end\") = {3};\n";
INSTANTIATE_TEST_SUITE_P(OrdersAndFormats, SplitFilesTest,
                         testing::Values(std::tuple(1, 4, withGroup), std::tuple(2, 3, inText),
                                         std::tuple(1, 5, "Mesh.MshFileVersion = 2.2; Mesh.Binary = 0;\n")));

using RefusedSplitFilesTest = SplitFilesTest;
INSTANTIATE_TEST_SUITE_P(InText, RefusedSplitFilesTest, testing::Values(std::tuple(1, 4, inText)));

TEST_P(RefusedSplitFilesTest, AFileThatIsMissingIsAHole) {
  mesh(boxes, 1, 4, inText);
  remove("part_3.msh");
  expectRefused(sceneOf("part_*.msh"), "is one of 4, but 3 files have such a name");
  expectRefused(sceneOf("other_*.msh"), "There are no mesh files");
}

TEST_P(RefusedSplitFilesTest, AFileThatIsCutOffIsRefusedOnAllRanks) {
  mesh(boxes, 1, 4, inText);
  if (world()->getRank() == 0)
    std::filesystem::resize_file(path("part_2.msh"), 9000);
  world()->barrier();
  expectRefused(sceneOf("part_*.msh"), "part_2.msh");
}

TEST_P(RefusedSplitFilesTest, FilesOfDifferentMeshesAreRefused) {
  mesh(boxes, 1, 4, inText);
  if (world()->getRank() == 0)
    std::filesystem::rename(path("part_2.msh"), path("kept.msh"));
  world()->barrier();
  mesh("Mesh.ScalingFactor = 1.001;\n" + std::string(boxes), 1, 4, inText);
  if (world()->getRank() == 0)
    std::filesystem::rename(path("kept.msh"), path("part_2.msh"));
  world()->barrier();
  expectRefused(sceneOf("part_*.msh"), "different places");
}

TEST_P(RefusedSplitFilesTest, WhatNoPieceHasIsRefused) {
  mesh(boxes, 1, 4, inText);
  scene::Scene scene = sceneOf("part_*.msh");
  scene.bodies[1].loads[1].point = {2.2, 1, 1.1};
  expectRefused(scene, "no node lies at the point");
  scene = sceneOf("part_*.msh");
  scene.bodies[1].loads[2].box = {{5, 5, 5}, {6, 6, 6}};
  expectRefused(scene, "no element has its centre in its box");
  scene = sceneOf("part_*.msh");
  scene.bodies[1].mesh.group = "middle";
  expectRefused(scene, "body 'right': none of the files ");
  expectRefused(scene, "they have 'left', 'right'");
  scene.bodies[1].mesh.group = "right";
  scene.bodies[1].decomposition.parts = 1000000;
  expectRefused(scene, "body 'right': it has ");
  expectRefused(scene, "cannot be cut into 1000000 parts");
  scene = sceneOf("part_*.msh");
  scene.bodies[0].supports[0].surface = "ceiling";
  expectRefused(scene, "names the surface 'ceiling'");
}

TEST_P(RefusedSplitFilesTest, AnOrderThatTheFilesDoNotHaveIsRefused) {
  mesh(boxes, 1, 4, inText);
  scene::Scene scene = sceneOf("part_*.msh");
  scene.bodies[0].mesh.order = 2;
  expectRefused(scene, "lacks nodes");
}

TEST_P(RefusedSplitFilesTest, PiecesThatAreNotJoinedAreRefused) {
  std::string apart(boxes);
  apart.erase(apart.find("Coherence;"), std::string("Coherence;").size());
  mesh(apart, 1, 4, inText);
  scene::Scene scene = sceneOf("part_*.msh");
  scene.bodies = {body("left", path("part_*.msh"), "")};
  scene.contacts.clear();
  expectRefused(scene, "parts are not joined with the others");
}

TEST_P(RefusedSplitFilesTest, MeshesThatEachRankWantsWholeAreRefused) {
  mesh(boxes, 1, 4, inText);
  epafi::test::expectRefusal([&] { decompose(sceneOf("part_*.msh"), world(), Meshes::whole); },
                             {"are read by parts"});
}

} // namespace
} // namespace epafi::decomposition
