#include "Decks.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;
using Numbers = std::vector<GlobalOrdinal>;

TEST(ConditionCardsTest, ReadsSupportsOfNodesAndSets) {
  const deck::Deck deck =
      withTetrahedron("*BOUNDARY\nbase, 1, 3\n4, 2\n3, 1,, 0.0\n2, 2, 2, -.5\n1, 1, 6\n4, 5\n");
  ASSERT_EQ(deck.boundaries.size(), 5u);
  EXPECT_EQ(deck.boundaries[0].nodes, (Numbers{1, 2, 3}));
  EXPECT_EQ(deck.boundaries[1].first, 2);
  EXPECT_EQ(deck.boundaries[1].last, 2);
  EXPECT_EQ(deck.boundaries[2].last, 1);
  EXPECT_EQ(deck.boundaries[3].value, -0.5);
  EXPECT_EQ(deck.boundaries[4].last, 3); // nodes of solids do not turn
  ASSERT_EQ(deck.ignored.size(), 1u);
  EXPECT_EQ(deck.ignored[0].keyword, "*BOUNDARY of rotations");
}

TEST(ConditionCardsTest, ReadsAbaqusNamesOfSupports) {
  const deck::Deck deck = withTetrahedron("*BOUNDARY\nbase, ENCASTRE\n4, ysymm\n");
  EXPECT_EQ(deck.boundaries[0].last, 3);
  EXPECT_EQ(deck.boundaries[1].first, 2);
  EXPECT_EQ(deck.boundaries[1].last, 2);
}

TEST(ConditionCardsTest, RefusesOtherSupports) {
  expectSays(refusalWith("*BOUNDARY\n1, 11, 11, 20.\n"),
             {"line 11: *BOUNDARY: ", "11 ... 11", "*TEMPERATURE"});
  expectSays(refusalWith("*BOUNDARY\n1, 3, 1\n"), {"line 11", "3 ... 1"});
  expectSays(refusalWith("*BOUNDARY\n1, 4, 4, .1\n"), {"line 11", "rotation"});
  expectSays(refusalWith("*BOUNDARY\nbas, 1\n"),
             {"line 11", "no set of nodes \"BAS\"", "did you mean \"BASE\"?"});
  expectSays(refusalWith("*BOUNDARY\n9, 1\n"), {"line 11", "no node 9"});
  expectSays(refusalWith("*BOUNDARY\n1, 1, 1, 0, 5\n"), {"line 11", "5 values"});
}

TEST(ConditionCardsTest, KeepsWhatStepsPrescribeApart) {
  const deck::Deck deck =
      withTetrahedron("*BOUNDARY\nbase, 1\n*AMPLITUDE, NAME=a, TIME=TOTAL TIME\n0, 0, 1, 1,\n2, .5\n"
                      "*STEP\n*STATIC\n.1, 2.\n*BOUNDARY, OP=NEW, AMPLITUDE=a\n4, 3, 3, 1\n"
                      "*CLOAD, TIME DELAY=1., AMPLITUDE=a\nbase, 2, 7.\n*END STEP\n"
                      "*STEP\n*STATIC\n*BOUNDARY, FIXED\n4, 3\n*CLOAD, OP=NEW\n*END STEP\n");
  EXPECT_EQ(deck.boundaries.size(), 1u);
  const deck::Amplitude& amplitude = deck.amplitudes.at("A");
  EXPECT_TRUE(amplitude.isOfTotalTime);
  EXPECT_EQ(amplitude.points, (std::vector<std::pair<double, double>>{{0, 0}, {1, 1}, {2, 0.5}}));
  ASSERT_EQ(deck.steps.size(), 2u);
  EXPECT_EQ(deck.steps[0].period, 2);
  EXPECT_TRUE(deck.steps[0].newBoundaries);
  EXPECT_FALSE(deck.steps[0].newForces);
  EXPECT_EQ(deck.steps[0].boundaries[0].amplitude, "A");
  EXPECT_EQ(deck.steps[0].forces[0].nodes, (Numbers{1, 2, 3}));
  EXPECT_EQ(deck.steps[0].forces[0].delay, 1);
  EXPECT_EQ(deck.steps[1].period, 1);
  EXPECT_TRUE(deck.steps[1].boundaries[0].isFixed);
  EXPECT_TRUE(deck.steps[1].newForces);
  EXPECT_TRUE(deck.steps[1].forces.empty());
}

TEST(ConditionCardsTest, ReadsLoads) {
  const deck::Step step = withTetrahedron("*SURFACE, NAME=s\n1, S1\n*STEP\n*STATIC\n*DLOAD\nEall, P4, 3.\n"
                                          "1, grav, 9810., 0, 0, -1\n1, CENTRIF, 1.D6, 0, 0, 0, 0, 0, 1\n"
                                          "*DSLOAD, OP=NEW\ns, P, 5.\n*TEMPERATURE\nbase, 100.\n*END STEP\n")
                              .steps[0];
  ASSERT_EQ(step.loads.size(), 4u);
  EXPECT_EQ(step.loads[0].label, "P4");
  EXPECT_EQ(step.loads[0].values, std::vector<double>{3});
  EXPECT_EQ(step.loads[1].values, (std::vector<double>{9810, 0, 0, -1}));
  EXPECT_EQ(step.loads[2].values, (std::vector<double>{1e6, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(step.loads[3].surface, "S");
  EXPECT_TRUE(step.newDistributedLoads);
  EXPECT_EQ(step.temperatures[0].value, 100);
}

TEST(ConditionCardsTest, RefusesOtherLoads) {
  expectSays(refusalInStep("*DLOAD\n1, P2NP, 1\n"), {"line 13: *DLOAD P2NP: ", "P1 ... P6"});
  expectSays(refusalInStep("*DLOAD\n1, P5, 1\n"), {"line 13", "no face for P5"});
  expectSays(refusalInStep("*DLOAD\n1, GRAV, 1, 0, 0, 0\n"), {"line 13", "direction"});
  expectSays(refusalInStep("*DLOAD\n1, P1\n"), {"line 13", "value 3", "left out"});
  expectSays(refusalInStep("*CLOAD\n1, 4, 1\n"), {"line 13: *CLOAD: ", "component is 4"});
  expectSays(refusalInStep("*CLOAD, AMPLITUDE=b\n1, 1, 1\n"), {"line 12", "no amplitude \"B\""});
  expectSays(refusalInStep("*CLOAD, OP=NWE\n"), {"line 12", "OP=NWE"});
  expectSays(refusalInStep("*DSLOAD\ns, P, 1\n"), {"line 13", "no surface \"S\""});
}

TEST(ConditionCardsTest, ReadsTemperaturesAtFirstAndNothingElse) {
  const deck::Deck deck = withTetrahedron("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNall, 293.\n");
  ASSERT_EQ(deck.initialTemperatures.size(), 1u);
  EXPECT_EQ(deck.initialTemperatures[0].value, 293);
  expectSays(refusalWith("*INITIAL CONDITIONS, TYPE=STRESS, USER\n"),
             {"line 10: *INITIAL CONDITIONS, TYPE=STRESS, USER: ", "TYPE=TEMPERATURE"});
}

TEST(ConditionCardsTest, ReadsEquationsOverSeveralLines) {
  const deck::Deck deck =
      withTetrahedron("*EQUATION\n2\n1, 1, 1., 2, 1, -1.\n3,\n1, 2, 1.,\n2, 2, 1., 3, 2, -2.,\n");
  ASSERT_EQ(deck.equations.size(), 2u);
  ASSERT_EQ(deck.equations[1].terms.size(), 3u);
  EXPECT_EQ(deck.equations[1].terms[2].node, 3);
  EXPECT_EQ(deck.equations[1].terms[2].component, 2);
  EXPECT_EQ(deck.equations[1].terms[2].factor, -2);
  EXPECT_EQ(deck.equations[1].place.line, 13);
}

TEST(ConditionCardsTest, RefusesWrongEquations) {
  expectSays(refusalWith("*EQUATION\n2\n1, 1, 1.\n"), {"line 10: *EQUATION: ", "fewer than the 2"});
  expectSays(refusalWith("*EQUATION\n1\n1, 1, 1., 2, 1, 1.\n"), {"line 12", "more than the 1"});
  expectSays(refusalWith("*EQUATION\n1\n1, 1\n"), {"line 12", "2 values"});
  expectSays(refusalWith("*EQUATION\n1\n1, 4, 1.\n"), {"line 12", "component 4"});
  expectSays(refusalWith("*EQUATION\n1\n9, 1, 1.\n"), {"line 12", "no node 9"});
  expectSays(refusalWith("*EQUATION\n1\n1, 1, 0.\n"), {"line 12", "factors", "0"});
}

TEST(ConditionCardsTest, ReadsAxesOfNodes) {
  const deck::Deck deck = withTetrahedron("*TRANSFORM, NSET=base, TYPE=C\n0, 0, 1, 0, 0, 2\n");
  ASSERT_EQ(deck.transforms.size(), 1u);
  EXPECT_TRUE(deck.transforms[0].isCylindrical);
  EXPECT_EQ(deck.transforms[0].nodes, (Numbers{1, 2, 3}));
  EXPECT_EQ(deck.transforms[0].b, (Point{0, 0, 2}));
  expectSays(refusalWith("*TRANSFORM, NSET=base, TYPE=S\n0, 0, 1, 0, 0, 2\n"), {"line 10", "TYPE=S"});
}

TEST(ConditionCardsTest, RefusesWrongAmplitudes) {
  expectSays(refusalWith("*AMPLITUDE, NAME=a\n1, 1, 0, 0\n"), {"line 11: *AMPLITUDE: ", "ascend"});
  expectSays(refusalWith("*AMPLITUDE, NAME=a\n1, 1, 2\n"), {"line 11", "value 4", "left out"});
  expectSays(refusalWith("*AMPLITUDE, NAME=a\n"), {"line 10", "no points"});
  expectSays(refusalWith("*AMPLITUDE, NAME=a, USER\n"), {"line 10", "subroutine"});
}

} // namespace
