#include "epafi/assembly/FaceWords.hpp"

#include "assembly/Assemblies.hpp"
#include "support/Refusal.hpp"

#include <algorithm>

namespace epafi {
namespace {

using namespace assembly;
using test::assemblyCalled;
using test::expectSays;
using test::refusal;

std::vector<int> numbersOf(const Assembly& assembly, const std::string& words) {
  std::vector<int> numbers;
  for (const int face : facesOf(assembly, words))
    numbers.push_back(assembly.faces[face].number);
  return numbers;
}

TEST(FaceWordsTest, StandForOneFaceEach) {
  for (const char* const name : {"blocks", "pin_in_lug", "shrink_fit", "flanges", "bracket", "ball_socket"}) {
    const Assembly& assembly = assemblyCalled(name);
    for (int f = 0; f < std::ssize(assembly.faces); ++f) {
      const std::string words = assembly.solids[assembly.faces[f].solid].name + '/' + wordsOf(assembly, f);
      EXPECT_EQ(facesOf(assembly, words), std::vector{f}) << words;
    }
  }
}

TEST(FaceWordsTest, SayKindDirectionSizeAndPlace) {
  const Assembly& assembly = assemblyCalled("flanges");
  EXPECT_EQ(numbersOf(assembly, "upper flange/plane -z"), std::vector{3});
  EXPECT_EQ(numbersOf(assembly, "upper flange/plane +z"), (std::vector{2, 10}));
  EXPECT_EQ(numbersOf(assembly, "upper flange/plane z=45"), std::vector{10});
  EXPECT_EQ(numbersOf(assembly, "upper flange/cylinder r=6.5"), (std::vector{4, 5, 7, 8}));
  EXPECT_EQ(numbersOf(assembly, "upper flange/cylinder r=6.5 x=45"), std::vector{7});
  EXPECT_EQ(numbersOf(assembly, "upper/face 9"), std::vector{9});
  EXPECT_EQ(numbersOf(assembly, "nut M12:*/cylinder r=6"), (std::vector{44, 48, 52, 56}));
}

TEST(FaceWordsTest, ThatMeanNothingAreAnsweredByTheFacesThereAre) {
  const Assembly& assembly = assemblyCalled("pin_in_lug");
  expectSays(
      refusal([&] { (void)facesOf(assembly, "pin/plane +z"); }),
      {"no face \"pin/plane +z\"", "cylinder r=10 y (face 8, area 1885, centre (0, 0, 0))", "plane +y"});
  expectSays(refusal([&] { (void)facesOf(assembly, "pin/plain +y"); }), {"plane +y"});
  expectSays(refusal([&] { (void)facesOf(assembly, "pins/plane +y"); }),
             {"no body \"pins\"", "\"lug\" and \"pin\""});
  expectSays(refusal([&] { (void)facesOf(assembly, "plane +y"); }), {"lacks its body"});
  expectSays(refusal([&] { (void)facesOf(assemblyCalled("flanges"), "bolt/plane"); }),
             {"several bodies", "\"bolt*\" means all"});
}

TEST(FaceWordsTest, OfPointsMeanTheCornerThatLiesThere) {
  const Assembly& assembly = assemblyCalled("blocks");
  const int corner = cornerOf(assembly, "upper block/point 10 -10 40");
  ASSERT_GE(corner, 0);
  EXPECT_NEAR(assembly.corners[corner].place[1], -10, 1e-9);
  EXPECT_EQ(cornerOf(assembly, "upper block/plane +z"), -1);
  expectSays(refusal([&] { (void)cornerOf(assembly, "upper block/point 0 0 40"); }),
             {"no corner", "nearest"});
}

TEST(FaceWordsTest, OfPartsWithoutNamesHaveNumbers) {
  EXPECT_EQ(assemblyCalled("onepart").solids[1].name, "solid 2");
}

} // namespace
} // namespace epafi
