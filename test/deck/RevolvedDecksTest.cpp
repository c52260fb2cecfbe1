#include "Decks.hpp"

#include "epafi/deck/DeckModel.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;

/// A ring of one CAX4, and cards of its step, from line 16 on.
std::string ring(const std::string& cards) {
  return "*NODE, NSET=Nall\n1, 1, 0\n2, 2, 0\n3, 2, 1\n4, 1, 1\n"
         "*ELEMENT, TYPE=CAX4, ELSET=Eall\n1, 1, 2, 3, 4\n"
         "*MATERIAL, NAME=steel\n*ELASTIC\n200., .3\n*DENSITY\n2.\n"
         "*SOLID SECTION, ELSET=Eall, MATERIAL=steel\n*STEP\n*STATIC\n" +
         cards + "*END STEP\n";
}

Teuchos::ParameterList bodyOf(const std::string& cards) {
  return deck::modelOf(deckOf(ring(cards)), "a.msh").scene.sublist("Bodies").sublist("body 1");
}

std::string refusalOfRing(const std::string& cards) {
  return refusal([&] { (void)bodyOf(cards); });
}

TEST(RevolvedDecksTest, BodiesAreAxisymmetricAndHoldWhatTheDeckSays) {
  Teuchos::ParameterList body = bodyOf("*DLOAD\nEall, CENTRIF, 9., 0., 5., 0., 0., 1., 0.\n");
  EXPECT_EQ(body.get<std::string>("Physics"), "axisymmetric");
  EXPECT_EQ(body.get<std::string>("Axis"), "free");
  EXPECT_FALSE(body.isParameter("Thickness"));
  Teuchos::ParameterList& turn = body.sublist("Loads").sublist("step 1 load 1");
  EXPECT_EQ(turn.get<std::string>("Kind"), "rotation");
  EXPECT_EQ(turn.get<double>("Value"), 18);
  EXPECT_FALSE(turn.isParameter("Point"));
}

TEST(RevolvedDecksTest, RefusesLoadsThatAreNotSymmetricAboutTheAxis) {
  expectSays(refusalOfRing("*DLOAD\nEall, GRAV, 9.81, 1., 0., 0.\n"),
             {"line 17", "GRAV", "along their axis"});
  EXPECT_NO_THROW((void)bodyOf("*DLOAD\nEall, GRAV, 9.81, 0., -1., 0.\n"));
  for (const std::string axis : {"0., 0., 0., 0., 0., 1.", "1., 0., 0., 0., 1., 0."})
    expectSays(refusalOfRing("*DLOAD\nEall, CENTRIF, 9., " + axis + "\n"), {"line 17", "CENTRIF", "axis, y"});
}

TEST(RevolvedDecksTest, RefusesPlaneElementsBesideThem) {
  const std::string text = ring("");
  std::string mixed = text;
  mixed.insert(mixed.find("*MATERIAL"), "*ELEMENT, TYPE=CPS4, ELSET=Eall\n2, 1, 2, 3, 4\n");
  expectSays(refusal([&] { (void)deck::modelOf(deckOf(mixed), "a.msh"); }),
             {"*ELEMENT", "CPS4 (plane stress)", "CAX4 (axisymmetric)"});
}

} // namespace
