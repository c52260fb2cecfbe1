// Results in CalculiX' format, read back by the columns that its manual has: numbers, places, values, and the
// same text on any number of ranks.

#include "FrdText.hpp"
#include "support/ElasticSample.hpp"
#include "support/Refusal.hpp"

#include "epafi/output/FrdFile.hpp"
#include "epafi/output/FrdRecords.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace epafi::output {
namespace {

using Coupling = scene::SurfaceContact::Coupling;
using Side = scene::SurfaceContact::Side;

/// All kinds of elements of one order.
std::vector<test::Kind> allKinds() {
  return {{fem::Physics::planeStrain, mesh::CellType::triangle},
          {fem::Physics::planeStress, mesh::CellType::quadrilateral},
          {fem::Physics::planeStrain, mesh::CellType::quadrilateral},
          {fem::Physics::elasticity3d, mesh::CellType::tetrahedron},
          {fem::Physics::elasticity3d, mesh::CellType::hexahedron}};
}

/// Calls test(kind, order) for all of both orders.
template <class Test>
void forAllKinds(const Test& test) {
  for (const test::Kind& kind : allKinds())
    for (const int order : {1, 2}) {
      SCOPED_TRACE(toString(kind.physics) + ", " + mesh::toString(kind.cell) + ", order " +
                   std::to_string(order));
      test(kind, order);
    }
}

struct FrdFileTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  bool isFirst = comm->getRank() == 0;
  test::TemporaryDirectory directory{comm};

  [[nodiscard]] scene::Scene blocks(const test::Kind& kind, int order, int parts = 3) const {
    scene::Scene scene = test::stackedBlocks(kind, parts, 3, directory, *comm);
    for (scene::Body& body : scene.bodies)
      body.mesh.order = order;
    return scene;
  }
  [[nodiscard]] static std::string textOf(const scene::Scene& scene, const test::Field& field,
                                          const RCP<const Comm>& ranks, const FrdNumbering& numbering = {}) {
    const auto decomposition = model::decompose(scene, ranks);
    const auto solution = test::solutionWith(decomposition, field);
    const simulation::SolvedScene solved{scene, decomposition, solution};
    FrdFile file(numbering);
    file.add(solved, simulation::evaluate(solved));
    return file.text();
  }
  [[nodiscard]] static std::string textOf(simulation::SceneRun& run) {
    FrdFile file;
    file.add(run.solved(), run.evaluation);
    return file.text();
  }
  [[nodiscard]] simulation::SceneRun solve(const scene::Scene& scene) const {
    Teuchos::ParameterList parameters;
    parameters.set("Tolerance", 1e-10).set("Equilibrium Tolerance", 1e-10);
    simulation::SceneRun run = simulation::solveScene(scene, parameters, comm);
    EXPECT_EQ(run.result.status, simulation::RunStatus::converged) << run.result.reason;
    return run;
  }
};

/// Linear, with stresses of all kinds.
std::array<double, 3> stretched(const Point& x) {
  return {0.011 * x[0] + 0.007 * x[1] + 0.003 * x[2], 0.002 * x[0] - 0.013 * x[1] + 0.0057 * x[2],
          0.0019 * x[0] + 0.0041 * x[1] + 0.017 * x[2]};
}

TEST_F(FrdFileTest, NodesElementsAndDisplacementsAreThoseOfTheBodies) {
  forAllKinds([&](const test::Kind& kind, int order) {
    const scene::Scene scene = blocks(kind, order);
    const Frd frd(textOf(scene, stretched, comm));
    if (!isFirst)
      return;
    const bool isPlane = mesh::dimensionOf(kind.cell) == 2;
    const int side = 4 * order + 1, perBody = isPlane ? side * side : side * side * side;
    EXPECT_TRUE(frd.isComplete);
    EXPECT_EQ(frd.materials, (std::vector<std::string>{"lower", "upper"}));
    ASSERT_EQ(frd.nodes.size(), static_cast<std::size_t>(2 * perBody));
    EXPECT_EQ(frd.numNodes, frd.nodes.size());
    EXPECT_EQ(frd.nodes.rbegin()->first, 2 * perBody);
    EXPECT_EQ(frd.numElements, frd.elements.size());
    ASSERT_EQ(frd.blocks.at(0).name, "DISP");
    EXPECT_EQ(frd.blocks[0].numNodes, frd.nodes.size());
    for (const auto& [number, place] : frd.nodes) {
      EXPECT_EQ(place.at(isPlane ? 1 : 2) > 1, number > perBody && place[isPlane ? 1 : 2] != 1) << number;
      const auto expected = stretched({place[0], place[1], place[2]});
      for (std::size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(frd.blocks[0].values.at(number).at(d), isPlane && d == 2 ? 0 : expected[d],
                    1e-5 * std::abs(expected[d]) + 1e-16);
    }
  });
}

TEST_F(FrdFileTest, NodesOnEdgesStandWhereTheFormatHasThem) {
  struct Format {
    int linear, quadratic; // the type
    std::size_t corners;
    std::vector<std::pair<int, int>> edges;
  };
  using mesh::CellType;
  // the manual of CalculiX GraphiX, Element Types, and, of he20, CalculiX' example contact2.frd.ref
  const std::map<CellType, Format> formats{
      {CellType::triangle, {7, 8, 3, {{0, 1}, {1, 2}, {2, 0}}}},
      {CellType::quadrilateral, {9, 10, 4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}}},
      {CellType::tetrahedron, {3, 6, 4, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}}},
      {CellType::hexahedron,
       {1,
        4,
        8,
        {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}}}}};
  forAllKinds([&](const test::Kind& kind, int order) {
    const Frd frd(textOf(blocks(kind, order), stretched, comm));
    const Format& format = formats.at(kind.cell);
    int number = 0;
    for (const FrdElement& element : frd.elements) {
      EXPECT_EQ(element.number, ++number);
      EXPECT_EQ(element.type, order == 2 ? format.quadratic : format.linear);
      ASSERT_EQ(element.nodes.size(), format.corners + (order == 2 ? format.edges.size() : 0));
      const bool isUpper = frd.nodes.at(*std::max_element(element.nodes.begin(), element.nodes.end()))
                               .at(mesh::dimensionOf(kind.cell) - 1) > 1;
      EXPECT_EQ(element.material, isUpper ? 2 : 1);
      for (std::size_t i = format.corners; i < element.nodes.size(); ++i)
        for (std::size_t d = 0; d < 3; ++d) {
          const auto [one, other] = format.edges[i - format.corners];
          EXPECT_NEAR(frd.nodes.at(element.nodes[i])[d],
                      (frd.nodes.at(element.nodes[one])[d] + frd.nodes.at(element.nodes[other])[d]) / 2, 1e-5)
              << "node " << i;
        }
    }
    EXPECT_EQ(isFirst, number > 0);
  });
}

/// The prism is element 17 of CalculiX' example c3d15.inp as ccx writes it. The format has no pyramids.
TEST_F(FrdFileTest, PrismsStandAsCalculixHasThemAndPyramidsAsHexahedraWithoutATop) {
  const std::vector<GlobalOrdinal> prism{10, 18, 17, 44, 52, 51, 21, 34, 20, 55, 68, 54, 35, 43, 42},
      pyramid{1, 2, 3, 4, 5};
  std::string text;
  putFrdElement(text, 17, 1, mesh::CellType::prism15, prism);
  putFrdElement(text, 18, 1, mesh::CellType::pyramid, pyramid);
  EXPECT_EQ(text,
            " -1        17    5    0    1\n"
            " -2        10        18        17        44        52        51        21        34        20"
            "        35\n"
            " -2        43        42        55        68        54\n"
            " -1        18    1    0    1\n"
            " -2         1         2         3         4         5         5         5         5\n");
}

TEST_F(FrdFileTest, ABarInTensionHasItsStressAndStrainAtEveryNode) {
  const auto pulled = [](const Point& x) { // by 1 %, E = 200, ν = 0.3
    return std::array<double, 3>{0.01 * x[0], -0.003 * x[1], -0.003 * x[2]};
  };
  forAllKinds([&](const test::Kind& kind, int order) {
    const Frd frd(textOf(blocks(kind, order), pulled, comm));
    if (!isFirst)
      return;
    // plane strain holds it across the plane, too: λ tr ε = ν/(1+ν)/(1−2ν) E · 0.007, and 2με beside it
    const bool isHeld = kind.physics == fem::Physics::planeStrain;
    const double across = 0.3 / 1.3 / 0.4 * 200 * 0.007, twiceMu = 200 / 1.3;
    using Components = std::array<double, 6>;
    const Components stress =
        isHeld ? Components{across + twiceMu * 0.01, across - twiceMu * 0.003, across} : Components{2};
    const Components strain{0.01, -0.003, mesh::dimensionOf(kind.cell) == 3 ? -0.003 : 0};
    for (const auto& [place, name, expected, tolerance] :
         {std::tuple{1, "STRESS", stress, 1e-5}, {2, "TOSTRAIN", strain, 1e-8}}) {
      const FrdBlock& block = frd.blocks.at(place);
      ASSERT_EQ(block.name, name);
      EXPECT_EQ(block.values.size(), frd.nodes.size());
      for (const auto& [number, values] : block.values)
        for (std::size_t k = 0; k < 6; ++k)
          EXPECT_NEAR(values.at(k), expected[k], tolerance) << name << ", " << number << ", " << k;
    }
  });
}

TEST_F(FrdFileTest, TheLoadIsThePressureAtTheNodesOfTheContactAlone) {
  forAllKinds([&](const test::Kind& kind, int order) {
    if (order == 2 && mesh::dimensionOf(kind.cell) == 3)
      return; // takes a minute, and has no other rows
    simulation::SceneRun run = solve(blocks(kind, order));
    const Frd frd(textOf(run));
    if (!isFirst)
      return;
    const std::size_t up = static_cast<std::size_t>(mesh::dimensionOf(kind.cell)) - 1;
    ASSERT_EQ(frd.blocks.size(), 5U);
    ASSERT_EQ(frd.blocks[4].name, "CONTACT");
    EXPECT_EQ(frd.blocks[4].numNodes, frd.blocks[4].values.size());
    EXPECT_EQ(frd.blocks[4].values.size(), static_cast<std::size_t>(std::pow(4 * order + 1, up)));
    for (const auto& [number, values] : frd.blocks[4].values) {
      EXPECT_EQ(frd.nodes.at(number)[up], 1) << number;
      ASSERT_EQ(values.size(), 6U);
      EXPECT_NEAR(values[0], 0, 1e-7) << "COPEN of " << number;
      EXPECT_NEAR(values[3], 3, 1e-4) << "CPRESS of " << number;
      for (const std::size_t k : {1U, 2U, 4U, 5U})
        EXPECT_EQ(values[k], 0) << number;
    }
  });
}

TEST_F(FrdFileTest, SlipAndShearAreThoseOfTheSideWithTheNodes) {
  // the upper block is pushed along x: its nodes slip on the lower one towards +x, those of that towards −x
  for (const bool isPlane : {true, false})
    for (const bool isUpperFirst : {true, false})
      for (const Side side : {Side::first, Side::second}) {
        SCOPED_TRACE(std::string(isPlane ? "plane" : "space") +
                     (isUpperFirst ? ", upper first" : ", lower first") +
                     (side == Side::first ? "" : ", rows on the second side"));
        const test::Kind kind = isPlane ? allKinds()[2] : allKinds()[4];
        scene::Scene scene = blocks(kind, 1);
        scene.bodies[0].supports = {{"foot", "bottom", {0.0, 0.0, 0.0}}};
        scene.bodies[1].supports = {isPlane ? fem::SolidSupport{"push", "top", {0.05, -0.01}}
                                            : fem::SolidSupport{"push", "top", {0.05, 0.0, -0.01}}};
        scene.bodies[1].loads.clear();
        if (isPlane)
          scene.bodies[0].supports[0].value[2].reset();
        scene::SurfaceContact& joint = scene.contacts[0];
        if (isUpperFirst) {
          std::swap(joint.first, joint.second);
          std::swap(joint.firstSurface, joint.secondSurface);
        }
        joint.coupling = Coupling::mortar;
        joint.multipliers = side;
        joint.friction = 0.2;
        simulation::SceneRun run = solve(scene);
        const Frd frd(textOf(run));
        if (!isFirst)
          continue;
        ASSERT_EQ(frd.blocks.at(4).name, "CONTACT");
        const bool areUpper = isUpperFirst == (side == Side::first);
        // the other side's normal is z, or y, for nodes of the upper block: its second tangent follows
        const double sign = areUpper ? 1 : -1;
        for (const auto& [number, values] : frd.blocks[4].values) {
          EXPECT_EQ(number > frd.nodes.rbegin()->first / 2, areUpper);
          EXPECT_LE(std::hypot(values[4], values[5]), 0.2 * values[3] * 1.0001 + 1e-9) << number;
        }
        const auto pressed = std::max_element(
            frd.blocks[4].values.begin(), frd.blocks[4].values.end(),
            [](const auto& a, const auto& b) { return std::abs(a.second[1]) < std::abs(b.second[1]); });
        const std::vector<double>& values = pressed->second;
        EXPECT_GT(sign * values[1], 1e-3) << "CSLIP1";
        EXPECT_GT(sign * values[4], 0) << "CSHEAR1";
      }
}

TEST_F(FrdFileTest, StepsFollowEachOtherOnOneMesh) {
  const scene::Scene scene = blocks(allKinds()[2], 1);
  const auto decomposition = model::decompose(scene, comm);
  FrdFile file;
  for (const int number : {1, 2, 3}) {
    const auto solution = test::solutionWith(decomposition, [number](const Point& x) {
      return std::array<double, 3>{number * x[0], 0, 0};
    });
    const simulation::SolvedScene solved{scene, decomposition, solution};
    file.add(solved, simulation::evaluate(solved), {number == 2 ? "" : "load it", number});
  }
  const Frd frd(file.text());
  if (!isFirst) {
    EXPECT_TRUE(file.text().empty());
    return;
  }
  EXPECT_TRUE(frd.isComplete);
  EXPECT_EQ(frd.nodes.size(), 50U);
  ASSERT_EQ(frd.blocks.size(), 15U);
  for (std::size_t k = 0; k < 15; ++k) {
    const FrdBlock& block = frd.blocks[k];
    const int number = static_cast<int>(k / 5) + 1;
    EXPECT_EQ(block.name, (std::array{"DISP", "STRESS", "TOSTRAIN", "FORC", "CONTACT"}[k % 5]));
    EXPECT_EQ(block.time, number);
    EXPECT_EQ(block.increment, number);
    EXPECT_EQ(block.numStep, number);
    EXPECT_EQ(block.step, number == 2 ? "" : "load it");
    if (k % 5 == 0) {
      EXPECT_NEAR(block.values.at(5).at(0), number * frd.nodes.at(5)[0], 1e-5);
    }
  }
}

TEST_F(FrdFileTest, TextIsTheSameOnAnyNumberOfRanksAndForEveryCut) {
  forAllKinds([&](const test::Kind& kind, int order) {
    const std::string whole = textOf(blocks(kind, order, 1), stretched, comm->split(comm->getRank(), 0));
    EXPECT_FALSE(whole.empty());
    EXPECT_EQ(textOf(blocks(kind, order, 5), stretched, comm), isFirst ? whole : "");
  });
}

TEST_F(FrdFileTest, GivenNumbersStandForNodesAndElements) {
  const scene::Scene scene = blocks(allKinds()[2], 1);
  const FrdNumbering numbering{[](int body, GlobalOrdinal node) { return 1000 * (2 - body) + 3 * node; },
                               [](int body, GlobalOrdinal element) { return 7 + 100 * body + element; }};
  const Frd plain(textOf(scene, stretched, comm)), given(textOf(scene, stretched, comm, numbering));
  if (!isFirst)
    return;
  const auto numberOf = [](int plainNumber) {
    return plainNumber <= 25 ? 2000 + 3 * (plainNumber - 1) : 1000 + 3 * (plainNumber - 26);
  };
  const auto renumbered = [&](const std::map<int, std::vector<double>>& values) {
    std::map<int, std::vector<double>> result;
    for (const auto& [number, row] : values)
      result.emplace(numberOf(number), row);
    return result;
  };
  EXPECT_EQ(given.nodes, renumbered(plain.nodes));
  ASSERT_EQ(given.blocks.size(), plain.blocks.size());
  for (std::size_t k = 0; k < plain.blocks.size(); ++k)
    EXPECT_EQ(given.blocks[k].values, renumbered(plain.blocks[k].values)) << plain.blocks[k].name;
  ASSERT_EQ(given.elements.size(), 32U);
  for (std::size_t e = 0; e < 32; ++e) {
    EXPECT_EQ(given.elements[e].number, e < 16 ? 7 + e : 107 + e - 16);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(given.elements[e].nodes[i], numberOf(plain.elements[e].nodes[i]));
  }
}

TEST(FrdRecordsTest, NumbersHaveTwelveColumnsWhateverTheirSize) {
  std::string text;
  putFrdNode(text, 7, std::vector<double>{-1.23456e-7, 1e-300, -1e300, -1.0 / 3, 9.999999e99, -0.0});
  EXPECT_EQ(text, " -1         7-1.23456E-07 0.00000E+00-3.40282E+38-3.33333E-01 3.40282E+38 0.00000E+00\n");
}

TEST(FrdRecordsTest, MembranesAreRefusedByTheirNames) {
  scene::Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].physics = fem::Physics::planeStress;
  scene.bodies[1].name = "drum";
  test::expectSays(test::refusal([&] { requireElasticBodies(scene, "run"); }), {"\"drum\""});
  scene.bodies.pop_back();
  EXPECT_NO_THROW(requireElasticBodies(scene, "run"));
}

} // namespace
} // namespace epafi::output
