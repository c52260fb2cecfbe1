#include "Decks.hpp"

#include "epafi/deck/Fields.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;

TEST(CardsTest, TakesKeywordsInAnyCaseWithBlanksAnywhere) {
  const deck::Deck plain = withTetrahedron("*BOUNDARY, OP=NEW\nbase,1,3\n");
  const deck::Deck odd = withTetrahedron("\n** a comment\r\n  * bound ARY , o p = new \r\n BASE , 1, 3,\r\n");
  ASSERT_EQ(plain.boundaries.size(), 1u);
  ASSERT_EQ(odd.boundaries.size(), 1u);
  EXPECT_EQ(odd.boundaries[0].nodes, plain.boundaries[0].nodes);
  EXPECT_EQ(odd.boundaries[0].last, 3);
  EXPECT_EQ(odd.boundaries[0].place.line, 13);
}

TEST(CardsTest, ContinuesAKeywordLineThatEndsInAComma) {
  const deck::Deck deck =
      deckOf("*NODE,\n** a comment between\n\nNSET=one\n1, 1.\n*NSET,\n NSET=two,\nGENERATE\n1, 1\n");
  EXPECT_EQ(deck.nodeSets.at("ONE"), std::vector<GlobalOrdinal>{1});
  EXPECT_EQ(deck.nodeSets.at("TWO"), std::vector<GlobalOrdinal>{1});
}

TEST(CardsTest, RefusesAKeywordLineThatIsContinuedByData) {
  expectSays(refusal([] { (void)deckOf("*NODE, NSET=N,\n1, 1.\n"); }), {"line 1: *NODE: ", "parameter 1 "});
}

TEST(CardsTest, ReadsNumbersOfCAndOfFortran) {
  const auto expectReal = [](const char* text, double value) {
    ASSERT_TRUE(deck::parsedReal(text)) << text;
    EXPECT_DOUBLE_EQ(*deck::parsedReal(text), value) << text;
  };
  expectReal("1", 1);
  expectReal("-.5", -0.5);
  expectReal("+2.", 2);
  expectReal("1.D-3", 1e-3);
  expectReal("1d+2", 100);
  expectReal("1.5E+02", 150);
  expectReal("0.1-101", 0.1e-101);
  expectReal("-1.25+100", -1.25e100);
  for (const char* const text :
       {"", "nan", "inf", "1e400", "1.2.3", "1 2", "0x1p3", "e5", "1,", "--1", "1-", "+-1"})
    EXPECT_FALSE(deck::parsedReal(text)) << text;
  EXPECT_EQ(deck::parsedWhole("12"), 12);
  for (const char* const text : {"", "1.", "1e2", "99999999999999999999", "1 2", "a"})
    EXPECT_FALSE(deck::parsedWhole(text)) << text;
}

TEST(CardsTest, PassesOverTextInFrontOfTheFirstKeyword) {
  const deck::Deck deck = deckOf("\n>** a beam\n1, 2, 3\n*NODE\n5, 0.\n");
  EXPECT_EQ(deck.nodes.numbers, std::vector<GlobalOrdinal>{5});
  ASSERT_EQ(deck.ignored.size(), 1u);
  EXPECT_EQ(deck.ignored[0].place.line, 2);
}

TEST(CardsTest, RefusesATextWithoutKeywords) {
  for (const char* const text : {"", "\n1, 2, 3\n", "** a comment\n"})
    expectSays(refusal([&] { (void)deckOf(text); }), {"a.inp, line 1: ", "no keyword"});
}

TEST(CardsTest, RefusesAnIncludeInAText) {
  expectSays(refusal([] { (void)deckOf("*INCLUDE, INPUT=b.inp\n"); }), {"a.inp, line 1: *INCLUDE: "});
}

TEST(CardsTest, NamesTheFieldThatIsNoNumber) {
  expectSays(refusal([] { (void)deckOf("*NODE\n1, 0., zero\n"); }),
             {"a.inp, line 2: *NODE: value 3 ", "a coordinate", "\"zero\""});
  expectSays(refusal([] { (void)deckOf("*NODE\n0, 0.\n"); }),
             {"line 2", "value 1", "number of a node", "\"0\""});
  expectSays(refusal([] { (void)deckOf("*NODE\n1, 1e999\n"); }), {"line 2", "\"1e999\""});
}

} // namespace
