#include "epafi/assembly/FacetSearch.hpp"

#include "assembly/Assemblies.hpp"
#include "support/Refusal.hpp"

#include "epafi/assembly/AssemblyPairs.hpp"
#include "epafi/assembly/AssemblyScene.hpp"
#include "epafi/meshing/GmshFile.hpp"
#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MeshFiles.hpp"

#include <cmath>
#include <deque>
#include <map>
#include <numbers>

namespace epafi {
namespace {

using namespace assembly;
using test::assemblyCalled;
using Teuchos::ParameterList;

/// The bodies of an assembly, as Gmsh meshes them.
struct Meshed {
  std::deque<mesh::UnstructuredMesh> meshes;
  std::vector<MeshedBody> bodies;
  MeshFaces faces;
};

/// Collective.
Meshed meshed(const std::string& name, int order, int around, const PairSearch& search = {}) {
  Meshed result;
  const std::string file = test::stepFile(name);
  const meshing::GmshFile mesh = meshing::meshOnAllRanks(
      file,
      [&] {
        return meshing::textOfMeshFile(file, 1, 0, order, {around, {}});
      },
      *Tpetra::getDefaultComm());
  for (const Solid& solid : assemblyCalled(name).solids) {
    result.meshes.push_back(mesh.body(solid.name));
    result.bodies.push_back({solid.name, &result.meshes.back()});
  }
  result.faces = meshFacesOf(result.bodies);
  findPairs(result.bodies, search, result.faces);
  return result;
}

using Sides = std::pair<std::string, std::string>; ///< body/face
Sides sidesOf(const Assembly& assembly, const FacePair& pair) {
  const auto name = [&](int face) {
    return assembly.solids[assembly.faces[face].solid].name + '/' + assembly.faces[face].group;
  };
  return std::minmax(name(pair.first), name(pair.second));
}

std::map<Sides, FacePair> named(const Assembly& assembly, const std::vector<FacePair>& pairs) {
  std::map<Sides, FacePair> result;
  for (const FacePair& pair : pairs)
    result.emplace(sidesOf(assembly, pair), pair);
  return result;
}

class FacetSearchTest : public testing::TestWithParam<const char*> {};

TEST_P(FacetSearchTest, FindsOnQuadraticFacetsWhatTheExactSurfacesHave) {
  const Assembly& exact = assemblyCalled(GetParam());
  const Meshed found = meshed(GetParam(), 2, elementsAroundFor(exact), {1e-3 * exact.diagonal(), 45});
  const Assembly& facets = found.faces.assembly;
  const auto pairs = named(facets, facets.pairs), expected = named(exact, exact.pairs);
  const double length = exact.diagonal();
  for (const auto& [sides, pair] : expected) {
    ASSERT_TRUE(pairs.contains(sides)) << sides.first << " - " << sides.second;
    const FacePair& other = pairs.at(sides);
    EXPECT_NEAR(other.leastGap, pair.leastGap, other.sag + 2e-6 * length)
        << sides.first << " - " << sides.second;
    EXPECT_LT(other.sag, 0.05 * 1e-3 * length);
    const double least = std::min(pair.area, other.area), most = std::max(pair.area, other.area);
    EXPECT_GT(least, (isPoint(exact, pair) ? 0.5 : 0.9) * most) << sides.first << " - " << sides.second;
  }
  EXPECT_EQ(pairs.size(), expected.size());
  EXPECT_EQ(facets.nearMisses.size(), exact.nearMisses.size());
}

INSTANTIATE_TEST_SUITE_P(Assemblies, FacetSearchTest,
                         testing::Values("blocks", "pin_in_lug", "shrink_fit", "flanges", "bracket",
                                         "ball_socket"),
                         [](const auto& set) { return std::string(set.param); });

ParameterList withAutomatic(double distance, const std::string& exclude = "") {
  ParameterList given;
  given.sublist("Contact").sublist("Automatic").set("Distance", distance).set("Exclude", exclude);
  return given;
}

/// 24 straight facets around a pin of radius 10 are off by 0.086, its clearance being 0.02.
TEST(CoarseFacetsTest, AreRefusedUnlessTheDistanceIsMuchGreater) {
  const double sag = 10 * (1 - std::cos(std::numbers::pi / 24));
  const auto pairsOf = [](const Meshed& bodies, const ParameterList& given, std::string& notes) {
    return assembly::pairsOf(bodies.bodies, bodies.faces, given, "given.xml", notes);
  };
  std::string notes;
  const Meshed coarse = meshed("pin_in_lug", 1, 24, {0.1, 45}), far = meshed("pin_in_lug", 1, 24, {2, 45});
  test::expectSays(test::refusal([&] { (void)pairsOf(coarse, withAutomatic(0.1), notes); }),
                   {"given.xml", "\"pin\"", "\"lug\"", "off the round surfaces by 0.", "order 2"});
  ASSERT_EQ(far.faces.assembly.pairs.size(), 1);
  EXPECT_GT(far.faces.assembly.pairs[0].sag, sag); // of both sides, as far as their triangles tell
  EXPECT_LT(far.faces.assembly.pairs[0].sag, 2.2 * sag);
  EXPECT_EQ(pairsOf(far, withAutomatic(2), notes).numParams(), 1);
  EXPECT_NE(notes.find("facets off by up to 0."), std::string::npos) << notes;
  EXPECT_EQ(pairsOf(coarse, withAutomatic(0.1, "pin"), notes).numParams(), 0); // left out, nothing to tell
}

/// Unit squares beside each other, a body each; the second one lies `gap` to the right.
struct Squares {
  std::deque<mesh::UnstructuredMesh> meshes;
  std::vector<MeshedBody> bodies;

  explicit Squares(double gap) {
    for (int body = 0; body < 2; ++body) {
      mesh::MeshArrays arrays;
      arrays.name = "The square";
      arrays.cellType = mesh::CellType::quadrilateral;
      const double x = body * (1 + gap);
      arrays.points = {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}};
      arrays.cells = {0, 1, 2, 3};
      arrays.nodeTags = {1, 2, 3, 4};
      arrays.elementTags = {1};
      if (body == 1)
        arrays.surfaces = {{"side", {3, 0}}};
      meshes.emplace_back(std::move(arrays));
      bodies.push_back({body == 0 ? "left" : "right", &meshes.back()});
    }
  }
  MeshFaces found(double distance) const {
    MeshFaces faces = meshFacesOf(bodies);
    findPairs(bodies, {distance, 45}, faces);
    return faces;
  }
};

TEST(FacetSearchInThePlaneTest, FindsGapsOverlapsAndNearMisses) {
  for (const double gap : {0.01, 0.0, -0.01}) {
    const MeshFaces faces = Squares(gap).found(0.02);
    ASSERT_EQ(faces.assembly.pairs.size(), 1) << gap;
    EXPECT_NEAR(faces.assembly.pairs[0].leastGap, gap, 1e-12);
    EXPECT_NEAR(faces.assembly.pairs[0].area, 1, 1e-12);
    EXPECT_EQ(sidesOf(faces.assembly, faces.assembly.pairs[0]), Sides("left/at 1 0.5", "right/side"));
  }
  const MeshFaces apart = Squares(0.05).found(0.02);
  EXPECT_TRUE(apart.assembly.pairs.empty());
  ASSERT_EQ(apart.assembly.nearMisses.size(), 1);
  EXPECT_NEAR(apart.assembly.nearMisses[0].leastGap, 0.05, 1e-12);
}

TEST(FacetSearchInThePlaneTest, LeavesOutBodiesThatHangTogetherAndPairsByHand) {
  Squares squares(0);
  std::string notes;
  ParameterList given = withAutomatic(0.02);
  const MeshFaces apart = squares.found(0.02);
  const ParameterList found = pairsOf(squares.bodies, apart, given, "given.xml", notes);
  EXPECT_EQ(found.sublist("left - right").get<std::string>("First Surface"), "at 1 0.5");
  EXPECT_NE(notes.find("left - right: plane on plane, area 1, gap 0"), std::string::npos) << notes;
  given.sublist("Contact")
      .sublist("joint")
      .set("First Body", "right")
      .set("First Surface", "side")
      .set("Second Body", "left")
      .set("Second Surface", "at 1 0.5");
  squares.meshes[0].namePiece("at 1 0.5"); // as the scene's reader has it
  const ParameterList own = pairsOf(squares.bodies, apart, given, "given.xml", notes);
  EXPECT_EQ(own.numParams(), 1);
  EXPECT_TRUE(own.isSublist("joint"));
  squares.bodies[0].nodeNumbers = {1, 2, 3, 4};
  squares.bodies[1].nodeNumbers = {2, 5, 6, 3};
  EXPECT_TRUE(squares.found(0.02).assembly.pairs.empty());
}

} // namespace
} // namespace epafi
