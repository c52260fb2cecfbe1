#include "Decks.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;
using Law = deck::Interaction::Law;

const std::string twoSurfaces = "*SURFACE, NAME=slave\n1, S1\n*SURFACE, NAME=master\n1, S2\n"
                                "*SURFACE, NAME=nodes, TYPE=NODE\nbase\n"; // lines 10 ... 15

deck::Deck withSurfaces(const std::string& cards) {
  return withTetrahedron(twoSurfaces + cards);
}

/// The first line that is tried is 16.
std::string refusalWithSurfaces(const std::string& cards) {
  return refusalWith(twoSurfaces + cards);
}

deck::Interaction interaction(const std::string& cards) {
  return withTetrahedron("*SURFACE INTERACTION, NAME=si\n" + cards).interactions.at("SI");
}

TEST(ContactCardsTest, ReadsLawsAndFriction) {
  EXPECT_EQ(interaction("").law, Law::hard);
  EXPECT_EQ(interaction("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n").law, Law::hard);
  const deck::Interaction linear =
      interaction("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E7, 3., .1\n*FRICTION\n.2, 80\n");
  EXPECT_EQ(linear.law, Law::linear);
  EXPECT_EQ(linear.stiffness, 1e7);
  EXPECT_EQ(linear.tension, 3);
  EXPECT_EQ(linear.friction, 0.2);
  EXPECT_EQ(linear.stickSlope, 80);
  const deck::Interaction tied = interaction("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.E7\n");
  EXPECT_EQ(tied.law, Law::tied);
  EXPECT_FALSE(tied.tension);
}

TEST(ContactCardsTest, RefusesOtherLaws) {
  const auto refusalOfLaw = [](const std::string& cards) {
    return refusalWith("*SURFACE INTERACTION, NAME=si\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=" + cards);
  };
  expectSays(refusalOfLaw("EXPONENTIAL\n1, 2\n"),
             {"line 11", "PRESSURE-OVERCLOSURE=EXPONENTIAL: ", "LINEAR"});
  expectSays(refusalOfLaw("LINER\n1\n"), {"line 11", "LINER"});
  expectSays(refusalOfLaw("LINEAR\n"), {"line 11", "stiffness"});
  expectSays(refusalOfLaw("LINEAR\n-1\n"), {"line 12", "positive"});
  expectSays(refusalWith("*FRICTION\n.1\n"), {"line 10", "*SURFACE INTERACTION"});
}

TEST(ContactCardsTest, ReadsPairsThatNameAnInteractionOfLater) {
  const deck::Deck deck =
      withSurfaces("*CONTACT PAIR, INTERACTION=si, TYPE=SURFACE TO SURFACE, ADJUST=.1, SMALL "
                   "SLIDING\nslave, master\n*CONTACT PAIR, INTERACTION=si, ADJUST=base\nnodes, "
                   "master\n*SURFACE INTERACTION, NAME=si\n");
  ASSERT_EQ(deck.contacts.size(), 2u);
  EXPECT_EQ(deck.contacts[0].dependent, "SLAVE");
  EXPECT_EQ(deck.contacts[0].independent, "MASTER");
  EXPECT_TRUE(deck.contacts[0].isSurfaceToSurface);
  EXPECT_EQ(deck.contacts[0].adjust, 0.1);
  EXPECT_FALSE(deck.contacts[1].isSurfaceToSurface);
  EXPECT_EQ(deck.contacts[1].adjustSet, "BASE");
}

TEST(ContactCardsTest, RefusesPairsOfWhatIsNotThere) {
  const std::string law = "*SURFACE INTERACTION, NAME=si\n";
  expectSays(refusalWithSurfaces(law + "*CONTACT PAIR, INTERACTION=si\nslave, mastr\n"),
             {"line 18: *CONTACT PAIR: ", "no surface \"MASTR\"", "\"MASTER\"?"});
  expectSays(refusalWithSurfaces(law + "*CONTACT PAIR, INTERACTION=s\nslave, master\n"),
             {"line 17", "no surface interaction \"S\""});
  expectSays(refusalWithSurfaces(law + "*CONTACT PAIR, INTERACTION=si\nslave\n"),
             {"line 18", "second surface"});
  expectSays(refusalWithSurfaces(law + "*CONTACT PAIR, INTERACTION=si\nslave, nodes\n"),
             {"line 18", "\"NODES\"", "faces"});
  expectSays(refusalWithSurfaces("*CLEARANCE, MASTER=master, SLAVE=slave, VALUE=1\n"),
             {"line 16: *CLEARANCE: "});
}

TEST(ContactCardsTest, ReadsTiesAndBolts) {
  const deck::Deck deck = withSurfaces("*TIE, NAME=t, POSITION TOLERANCE=.1, ADJUST=NO\nnodes, master\n"
                                       "*PRE-TENSION SECTION, SURFACE=slave, NODE=4\n0, 0, -1\n");
  ASSERT_EQ(deck.ties.size(), 1u);
  EXPECT_EQ(deck.ties[0].dependent, "NODES");
  EXPECT_EQ(deck.ties[0].tolerance, 0.1);
  ASSERT_EQ(deck.pretensions.size(), 1u);
  EXPECT_EQ(deck.pretensions[0].node, 4);
  EXPECT_EQ(deck.pretensions[0].direction, (Point{0, 0, -1}));
  expectSays(refusalWithSurfaces("*PRE-TENSION SECTION, SURFACE=slave, NODE=9\n"), {"line 16", "no node 9"});
  expectSays(refusalWithSurfaces("*PRE-TENSION SECTION, NODE=4\n"), {"line 16", "SURFACE="});
  expectSays(refusalWithSurfaces("*TIE, NAME=t, CYCLIC SYMMETRY\nslave, master\n"),
             {"line 16: *TIE, CYCLIC SYMMETRY: "});
}

TEST(ContactCardsTest, ReadsWhatStepsChange) {
  const std::string model = "*SURFACE INTERACTION, NAME=si\n*FRICTION\n.3\n*CONTACT PAIR, INTERACTION=si\n"
                            "slave, master\n*STEP\n*STATIC\n";
  const deck::Deck deck =
      withSurfaces(model + "*CHANGE FRICTION, INTERACTION=si\n*FRICTION\n.1, 50\n"
                           "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nslave, master\n*END STEP\n");
  ASSERT_EQ(deck.steps.size(), 1u);
  ASSERT_EQ(deck.steps[0].frictions.size(), 1u);
  EXPECT_EQ(deck.steps[0].frictions[0].friction, 0.1);
  EXPECT_EQ(deck.steps[0].frictions[0].stickSlope, 50);
  EXPECT_EQ(deck.interactions.at("SI").friction, 0.3);
  ASSERT_EQ(deck.steps[0].pairs.size(), 1u);
  EXPECT_FALSE(deck.steps[0].pairs[0].isAdded);
  const auto refusalInThatStep = [&](const std::string& cards) {
    return refusalWithSurfaces(model + cards + "*END STEP\n");
  };
  expectSays(refusalInThatStep("*FRICTION\n.1\n"), {"line 23", "*CHANGE FRICTION"});
  expectSays(refusalInThatStep("*CHANGE FRICTION, INTERACTION=si\n"), {"line 24: *END STEP", "*FRICTION"});
  expectSays(refusalInThatStep("*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nmaster, slave\n"),
             {"line 24", "no contact pair"});
  expectSays(refusalInThatStep("*MODEL CHANGE, TYPE=ELEMENT, REMOVE\n1\n"),
             {"line 23: *MODEL CHANGE, TYPE=ELEMENT: "});
}

} // namespace
