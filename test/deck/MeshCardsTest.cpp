#include "Decks.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;
using Numbers = std::vector<GlobalOrdinal>;

TEST(MeshCardsTest, SortsNodesAndTakesTheLastDefinition) {
  const deck::Deck deck = deckOf("*NODE, NSET=N\n3, 3.\n1, 1., 2., 3.\n*NODE\n3, 4., 5.\n");
  EXPECT_EQ(deck.nodes.numbers, (Numbers{1, 3}));
  EXPECT_EQ(deck.nodes.points, (std::vector<Point>{{1, 2, 3}, {4, 5, 0}}));
  EXPECT_EQ(deck.nodeSets.at("N"), (Numbers{1, 3}));
}

TEST(MeshCardsTest, ReadsAnElementOverSeveralLines) {
  std::string nodes;
  for (int n = 1; n <= 8; ++n)
    nodes += std::to_string(n) + ", " + std::to_string(n) + ".\n";
  const std::string expected = "*ELEMENT, TYPE=c3d8, ELSET=E\n";
  for (const char* const written : {"7, 8, 7, 6, 5, 4, 3, 2, 1\n", "7, 8, 7,\n6, 5, 4, 3\n2, 1,\n"}) {
    const deck::Deck deck = deckOf("*NODE\n" + nodes + expected + written);
    ASSERT_EQ(deck.elements.size(), 1u);
    EXPECT_EQ(deck.elements[0].type, "C3D8");
    EXPECT_EQ(deck.elements[0].nodesPerElement, 8);
    EXPECT_EQ(deck.elements[0].nodes, (Numbers{8, 7, 6, 5, 4, 3, 2, 1}));
    EXPECT_EQ(deck.elements[0].place.line, 10);
    EXPECT_EQ(deck.elementSets.at("E"), Numbers{7});
  }
}

TEST(MeshCardsTest, KeepsTheElementsOfATypeTogetherAndSorted) {
  const deck::Deck deck = withTetrahedron("*NODE\n5, 1, 1\n*ELEMENT, TYPE=CPS3\n7, 1, 2, 3\n"
                                          "*ELEMENT, TYPE=C3D4\n9, 2, 3, 4, 5\n3, 1, 2, 3, 5\n");
  ASSERT_EQ(deck.elements.size(), 2u);
  EXPECT_EQ(deck.elements[0].type, "C3D4");
  EXPECT_EQ(deck.elements[0].numbers, (Numbers{1, 3, 9}));
  EXPECT_EQ(deck.elements[0].nodes, (Numbers{1, 2, 3, 4, 1, 2, 3, 5, 2, 3, 4, 5}));
  EXPECT_EQ(deck.elements[1].numbers, Numbers{7});
}

TEST(MeshCardsTest, RefusesWrongElements) {
  expectSays(refusalWith("*ELEMENT, TYPE=C3D4\n2, 1, 2, 3, 9\n"), {"line 11: *ELEMENT: ", "no node 9"});
  expectSays(refusalWith("*ELEMENT, TYPE=C3D4\n2, 1, 2, 3, 4, 1\n"),
             {"line 11", "element 2 has more than the 4"});
  expectSays(refusalWith("*ELEMENT, TYPE=C3D4\n2, 1, 2, 3\n*NSET, NSET=x\n1\n"),
             {"line 11", "element 2 has 3 nodes"});
  expectSays(refusalWith("*ELEMENT, TYPE=C3D4\n1, 2, 1, 4, 3\n"),
             {"line 11", "element 1 is defined in a.inp, line 7"});
  expectSays(refusalWith("*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n"), {"element 1 is also one of type C3D4"});
  expectSays(refusalWith("*ELEMENT, TYPE=B31\n2, 1, 2\n"), {"line 10: *ELEMENT, TYPE=B31: beams ", "C3D20R"});
  EXPECT_EQ(withTetrahedron("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n").elements[0].numbers, Numbers{1});
}

TEST(MeshCardsTest, AddsUpTheCardsOfASet) {
  const deck::Deck deck =
      withTetrahedron("*NSET, NSET=A\n4, 1,\n*NSET, NSET=B\nA, 2\n1, A\n*NSET, NSET=A\n3\n"
                      "*ELSET, ELSET=A\nEall\n*NSET, NSET=empty\n");
  EXPECT_EQ(deck.nodeSets.at("A"), (Numbers{1, 3, 4}));
  EXPECT_EQ(deck.nodeSets.at("B"), (Numbers{1, 2, 4}));
  EXPECT_EQ(deck.elementSets.at("A"), Numbers{1});
  EXPECT_TRUE(deck.nodeSets.at("EMPTY").empty());
}

TEST(MeshCardsTest, GeneratesNumbersThatAreDefined) {
  const deck::Deck deck =
      withTetrahedron("*NSET, NSET=A, GENERATE\n2, 1000000000000\n*NSET, NSET=B, GENERATE\n1, 9, 2\n3\n");
  EXPECT_EQ(deck.nodeSets.at("A"), (Numbers{2, 3, 4}));
  EXPECT_EQ(deck.nodeSets.at("B"), (Numbers{1, 3}));
  expectSays(refusalWith("*NSET, NSET=A, GENERATE\n4, 1\n"),
             {"line 11: *NSET: ", "ends at 1", "begins at 4"});
  expectSays(refusalWith("*NSET, NSET=A, GENERATE\n1, 4, 0\n"), {"line 11", "increment"});
}

TEST(MeshCardsTest, StaysSmallWhereASetNamesItself) {
  std::string cards = "*NSET, NSET=A\n1, 2\n*NSET, NSET=A\n";
  for (int i = 0; i < 1000; ++i)
    cards += "A, A\n";
  EXPECT_EQ(withTetrahedron(cards).nodeSets.at("A"), (Numbers{1, 2}));
}

TEST(MeshCardsTest, RefusesMembersThatAreNotThere) {
  expectSays(refusalWith("*NSET, NSET=A\n1, 9\n"), {"line 11: *NSET: ", "node 9"});
  expectSays(refusalWith("*ELSET, ELSET=A\nE\n"), {"line 11: *ELSET: ", "no set \"E\""});
  expectSays(refusalWith("*NSET\n1\n"), {"line 10: *NSET: ", "needs NSET="});
}

TEST(MeshCardsTest, ReadsSurfacesOfFacesAndOfNodes) {
  const deck::Deck deck = withTetrahedron("*SURFACE, NAME=a\nEall, S3\n1, S1\n1, s3\n"
                                          "*SURFACE, NAME=b, TYPE=NODE\nbase\n4, 1.\n");
  EXPECT_EQ(deck.surfaces.at("A").faces, (std::vector<std::pair<GlobalOrdinal, int>>{{1, 1}, {1, 3}}));
  EXPECT_FALSE(deck.surfaces.at("A").ofNodes);
  EXPECT_TRUE(deck.surfaces.at("B").ofNodes);
  EXPECT_EQ(deck.surfaces.at("B").nodes, (Numbers{1, 2, 3, 4}));
  expectSays(refusalWith("*SURFACE, NAME=a\n1, S5\n"), {"line 11", "element 1 of type C3D4 has no face S5"});
  expectSays(refusalWith("*SURFACE, NAME=a\n1, SPOS\n"), {"line 11", "\"SPOS\""});
  expectSays(refusalWith("*SURFACE, NAME=a\n2, S1\n"), {"line 11", "no element 2"});
  expectSays(refusalWith("*SURFACE, NAME=a\n1, S1\n*SURFACE, NAME=A\n1, S2\n"), {"line 12", "line 10"});
}

} // namespace
