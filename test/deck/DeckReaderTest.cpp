#include "Decks.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;

TEST(DeckReaderTest, SuggestsTheNearestKeywordAndParameter) {
  expectSays(refusalWith("*SOLID SETCION, ELSET=Eall\n"),
             {"a.inp, line 10: *SOLID SETCION: ", "*SOLID SECTION?"});
  expectSays(refusalWith("*STEP, NLGOEM\n*STATIC\n*END STEP\n"), {"line 10: *STEP: ", "NLGOEM", "NLGEOM?"});
  expectSays(refusalWith("*QQQQQQQQ\n"), {"line 10: *QQQQQQQQ: ", "not known"});
}

TEST(DeckReaderTest, NamesTheFirstThingBeyondAndOthersBehind) {
  const std::string message =
      refusalWith("*STEP\n*FREQUENCY\n5\n*END STEP\n*STEP\n*HEAT TRANSFER\n*END STEP\n*MPC\nPLANE, 1, 2\n");
  expectSays(message, {"a.inp, line 11: *FREQUENCY: ", "*STATIC", "*HEAT TRANSFER (a.inp, line 15)",
                       "*MPC PLANE (a.inp, line 17)"});
  EXPECT_EQ(message.find("*FREQUENCY"), message.rfind("*FREQUENCY"));
}

TEST(DeckReaderTest, PassesOverWhatMakesNoDifferenceAndNamesItOnce) {
  const deck::Deck deck =
      withStep("*NODE FILE\nU\n*EL FILE\nS\n*NODE FILE, FREQUENCY=5\nRF\n*RESTART, WRITE\n"
               "*ENERGY PRINT, ELSET=base\nELSE\n");
  ASSERT_EQ(deck.ignored.size(), 4u);
  EXPECT_EQ(deck.ignored[0].keyword, "*NODE FILE");
  EXPECT_EQ(deck.ignored[0].place.line, 12);
  EXPECT_EQ(deck.ignored[2].keyword, "*RESTART");
  EXPECT_EQ(deck.ignored[3].keyword, "*ENERGY PRINT");
  EXPECT_EQ(withTetrahedron("*STEP\n*STATIC, SOLVER=SPOOLES\n*END STEP\n").ignored[0].keyword,
            "*STATIC, SOLVER");
  expectSays(refusalInStep("*RESTART, READ\n"), {"line 12: *RESTART, READ: "});
}

TEST(DeckReaderTest, ReadsWhatIsToBePrinted) {
  const deck::Deck deck = withTetrahedron(
      "*SURFACE, NAME=face\nEall, S1\n*STEP\n*STATIC\n"
      "*NODE PRINT, NSET=BASE, TOTALS=ONLY, FREQUENCY=9\nRF, NT\n*CONTACT PRINT\nCF, CSTR, CELS\n"
      "*EL PRINT, ELSET=Eall, GLOBAL=YES\nS, E, PEEQ\n*SECTION PRINT, SURFACE=face, NAME=x\nSOF\n"
      "*END STEP\n");
  const std::vector<deck::Print>& prints = deck.steps[0].prints;
  ASSERT_EQ(prints.size(), 4u);
  EXPECT_EQ(prints[0].set, "BASE");
  EXPECT_EQ(prints[0].fields, std::vector<std::string>{"RF"});
  EXPECT_EQ(prints[0].totals, deck::Print::Totals::alone);
  EXPECT_EQ(prints[1].fields, (std::vector<std::string>{"CF", "CSTR"}));
  EXPECT_EQ(prints[1].totals, deck::Print::Totals::none);
  EXPECT_EQ(prints[2].of, deck::Print::Of::elements);
  EXPECT_EQ(prints[2].set, "EALL");
  EXPECT_EQ(prints[2].fields, (std::vector<std::string>{"S", "E"}));
  EXPECT_EQ(prints[3].of, deck::Print::Of::section);
  EXPECT_EQ(prints[3].set, "FACE");
  ASSERT_EQ(deck.ignored.size(), 3u);
  EXPECT_EQ(deck.ignored[0].keyword, "*NODE PRINT NT");
  EXPECT_EQ(deck.ignored[1].keyword, "*CONTACT PRINT CELS");
  EXPECT_EQ(deck.ignored[2].keyword, "*EL PRINT PEEQ");
  expectSays(refusalInStep("*SECTION PRINT, SURFACE=none, NAME=x\nSOF\n"), {"*SECTION PRINT", "NONE"});
}

TEST(DeckReaderTest, ReadsTheTitle) {
  EXPECT_EQ(deckOf("*HEADING\nA beam, bent\nmore of it\n*NODE\n1\n").title, "A beam, bent");
}

TEST(DeckReaderTest, KeepsGeometryNonlinearFromStepToStep) {
  const std::string end = "\n*STATIC\n*END STEP\n";
  const deck::Deck deck = withTetrahedron("*STEP" + end + "*STEP, NLGEOM" + end + "*STEP, INC=5" + end +
                                          "*STEP, NLGEOM=NO" + end + "*STEP, PERTURBATION" + end);
  std::vector<bool> isNonlinear;
  for (const deck::Step& step : deck.steps)
    isNonlinear.push_back(step.isNonlinear);
  EXPECT_EQ(isNonlinear, (std::vector<bool>{false, true, true, false, false}));
}

TEST(DeckReaderTest, RefusesStepsThatAreNotWhole) {
  expectSays(refusalWith("*STEP\n*STATIC\n"), {"line 10: *STEP: ", "*END STEP"});
  expectSays(refusalWith("*STEP\n*STATIC\n*STEP\n"), {"line 12: *STEP: ", "line 10", "*END STEP"});
  expectSays(refusalWith("*STEP\n*END STEP\n"), {"line 11: *END STEP: ", "no *STATIC"});
  expectSays(refusalWith("*STEP\n*STATIC\n*STATIC\n*END STEP\n"), {"line 12", "one already"});
  expectSays(refusalWith("*CLOAD\n1, 1, 1.\n"), {"line 10: *CLOAD: ", "belongs in a step"});
  expectSays(refusalWith("*END STEP\n"), {"line 10", "belongs in a step"});
  expectSays(refusalInStep("*MATERIAL, NAME=m\n"), {"line 12: *MATERIAL: ", "before the first *STEP"});
  expectSays(refusalWith("*STEP\n*STATIC\n1., 0.\n*END STEP\n"), {"line 12", "period"});
}

} // namespace
