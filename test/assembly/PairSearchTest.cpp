#include "assembly/Assemblies.hpp"
#include "support/Refusal.hpp"
#include "support/TemporaryDirectory.hpp"

#include "epafi/meshing/GmshFile.hpp"
#include "epafi/meshing/GmshReader.hpp"

#include <fstream>
#include <regex>
#include <sstream>

namespace epafi {
namespace {

using namespace assembly;
using test::assemblyCalled;

/// A line of pairs.csv.
struct ExpectedPair {
  bool isNear;
  double faceArea, area, leastGap, largestGap;
};
using FaceNumbers = std::pair<int, int>;

std::map<FaceNumbers, ExpectedPair> expectedPairs(const std::string& name) {
  std::ifstream file(EPAFI_SOURCE_DIR "/test/assembly/pairs.csv");
  std::map<FaceNumbers, ExpectedPair> pairs;
  for (std::string line; std::getline(file, line);) {
    std::istringstream stream(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(stream, cell, ',');)
      cells.push_back(cell);
    if (cells[0] == name)
      pairs[{std::stoi(cells[3]), std::stoi(cells[6])}] = {cells[1] == "yes", std::stod(cells[9]),
                                                           std::stod(cells[8]), std::stod(cells[10]),
                                                           std::stod(cells[11])};
  }
  return pairs;
}

FaceNumbers numbersOf(const Assembly& assembly, const FacePair& pair) {
  return {assembly.faces[pair.first].number, assembly.faces[pair.second].number};
}

/// Whatever face is called the first.
FaceNumbers sorted(FaceNumbers pair) {
  return std::minmax(pair.first, pair.second);
}

class PairSearchTest : public testing::TestWithParam<const char*> {};

TEST_P(PairSearchTest, FindsThePairsThatThereAreAndNoOthers) {
  const Assembly& assembly = assemblyCalled(GetParam());
  std::set<FaceNumbers> near, far, expectedNear, expectedFar;
  for (const FacePair& pair : assembly.pairs)
    near.insert(sorted(numbersOf(assembly, pair)));
  for (const FacePair& pair : assembly.nearMisses)
    far.insert(sorted(numbersOf(assembly, pair)));
  for (const auto& [faces, pair] : expectedPairs(GetParam()))
    (pair.isNear ? expectedNear : expectedFar).insert(sorted(faces));
  EXPECT_FALSE(expectedNear.empty());
  EXPECT_EQ(near, expectedNear);
  EXPECT_EQ(far, expectedFar);
}

/// The file's gaps are those of samples: the least gap can only be less.
TEST_P(PairSearchTest, MeasuresGapsOnTheExactSurfaces) {
  const Assembly& assembly = assemblyCalled(GetParam());
  const auto expected = expectedPairs(GetParam());
  for (const FacePair& pair : assembly.pairs) {
    const auto found = expected.find(numbersOf(assembly, pair));
    if (found == expected.end()) // other names of the two
      continue;
    const auto& [isNear, faceArea, area, leastGap, largestGap] = found->second;
    EXPECT_NEAR(assembly.faces[pair.first].area, faceArea, 5e-3 * faceArea);
    if (leastGap == largestGap) {
      EXPECT_NEAR(pair.leastGap, leastGap, 1e-5);
      EXPECT_NEAR(pair.largestGap, leastGap, 1e-5);
    } else {
      EXPECT_NEAR(pair.leastGap, 0, 1e-5); // a ball touches in a point
      EXPECT_GE(leastGap, pair.leastGap);
    }
    EXPECT_LE(pair.area, faceArea * 1.005);
  }
}

INSTANTIATE_TEST_SUITE_P(Assemblies, PairSearchTest,
                         testing::Values("blocks", "pin_in_lug", "shrink_fit", "flanges", "bracket",
                                         "ball_socket"),
                         [](const auto& set) { return std::string(set.param); });

TEST(PairSearchUnitsTest, OfInchesAndMetresAreThoseOfMillimetres) {
  const Assembly& blocks = assemblyCalled("blocks");
  std::ifstream file(test::stepFile("blocks"));
  std::string text{std::istreambuf_iterator<char>(file), {}}, metres;
  text = std::regex_replace(
      text, std::regex("\\(\\.MILLI\\.,\\.METRE\\.\\)|\\(\\.MILLI\\.,\\s*\\.METRE\\.\\)"), "($,.METRE.)");
  const std::regex point("(CARTESIAN_POINT\\('',\\()([^)]*)\\)");
  std::size_t end = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), point); match != std::sregex_iterator();
       ++match) {
    metres += text.substr(end, match->position() - end) + (*match)[1].str();
    std::istringstream coordinates((*match)[2].str());
    std::string separator;
    for (std::string number; std::getline(coordinates, number, ','); separator = ",")
      metres += separator +
                std::regex_replace(std::to_string(std::stod(number) / 1000), std::regex("^(-?\\d+)$"), "$1.");
    metres += ')';
    end = match->position() + match->length();
  }
  metres += text.substr(end);
  const auto comm = Tpetra::getDefaultComm();
  const test::TemporaryDirectory folder(comm);
  const std::string inMetres = folder.path() / "metres.step";
  if (comm->getRank() == 0)
    std::ofstream(inMetres) << metres;
  for (const auto& [other, unit] :
       {std::pair{assemblyCalled("blocks_inch"), "inch"}, {readAssembly(inMetres, {}, *comm), "m"}}) {
    EXPECT_EQ(other.unit, unit);
    EXPECT_EQ(blocks.unit, "mm");
    ASSERT_EQ(other.solids.size(), blocks.solids.size());
    EXPECT_EQ(other.solids[1].name, "upper block");
    EXPECT_NEAR(other.diagonal(), blocks.diagonal(), 1e-3);
    EXPECT_NEAR(other.solids[0].volume, 32000, 1);
    ASSERT_EQ(other.pairs.size(), 1);
    EXPECT_EQ(numbersOf(other, other.pairs[0]), FaceNumbers(11, 6));
    EXPECT_NEAR(other.pairs[0].area, 400, 1e-2);
  }
}

TEST(PairSearchDistanceTest, TakesNearMissesIn) {
  const Assembly shanks = readAssembly(test::stepFile("bracket"), {0.6, 45}, *Tpetra::getDefaultComm());
  EXPECT_EQ(shanks.pairs.size(), 7 + 4);
}

/// The mesh that goes with the faces' numbers.
TEST(StepMeshTest, HasSolidsAndFacesByNameAndIsFineWhereItIsAskedToBe) {
  const std::string file = test::stepFile("blocks");
  const auto blocksOf = [&](const meshing::StepSizes& sizes) {
    return meshing::GmshFile(meshing::readMsh(file, meshing::textOfMeshFile(file, 1, 0, 2, sizes)))
        .body("upper block");
  };
  const mesh::UnstructuredMesh coarse = blocksOf({}), fine = blocksOf({16, {0, 0, 20, 0.4}});
  for (const mesh::UnstructuredMesh* const block : {&coarse, &fine}) {
    const std::vector<std::string> names = block->surfaceNames();
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()),
              (std::set<std::string>{"face 7", "face 8", "face 9", "face 10", "face 11", "face 12"}));
  }
  const auto numNear = [](const mesh::UnstructuredMesh& block) {
    int number = 0;
    for (GlobalOrdinal node = 0; node < block.numNodes(); ++node) {
      const Point at = block.point(node);
      number += static_cast<int>(std::hypot(at[0], at[1], at[2] - 20) < 1.2);
    }
    return number;
  };
  EXPECT_LE(numNear(coarse), 2);
  EXPECT_GT(numNear(fine), 50); // half a ball of 3.6 mm³, some 0.005 mm³ an element
  EXPECT_LT(fine.numNodes(), 10 * coarse.numNodes());
}

TEST(PairSearchFileTest, ThatIsNoneIsRefused) {
  const auto comm = Tpetra::getDefaultComm();
  const test::TemporaryDirectory folder(comm);
  test::expectSays(test::refusal([&] { (void)readAssembly(folder.path() / "none.step", {}, *comm); }),
                   {"none.step", "There is no"});
  if (comm->getRank() == 0)
    std::ofstream(folder.path() / "empty.step") << "ISO-10303-21;\nEND-ISO-10303-21;\n";
  comm->barrier();
  test::expectSays(test::refusal([&] { (void)readAssembly(folder.path() / "empty.step", {}, *comm); }),
                   {"empty.step"});
}

} // namespace
} // namespace epafi
