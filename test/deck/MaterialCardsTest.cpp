#include "Decks.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;
using Kind = deck::ElasticConstants::Kind;

deck::Material material(const std::string& cards) {
  return withTetrahedron("*MATERIAL, NAME=m\n" + cards).materials.at("M");
}

TEST(MaterialCardsTest, ReadsConstantsOverTemperature) {
  const deck::Material steel = material("*ELASTIC\n210.D3, .3\n200.D3, .31, 100.\n*DENSITY\n7.8e-9\n"
                                        "*EXPANSION, ZERO=20.\n1.e-5\n");
  EXPECT_EQ(steel.elastic->kind, Kind::isotropic);
  ASSERT_EQ(steel.elastic->rows.size(), 2u);
  EXPECT_EQ(steel.elastic->rows[0].constants, (std::vector<double>{210e3, 0.3}));
  EXPECT_EQ(steel.elastic->rows[1].temperature, 100);
  EXPECT_EQ(steel.density, 7.8e-9);
  EXPECT_EQ(steel.expansion->zero, 20);
  EXPECT_EQ(steel.expansion->rows[0].coefficients, std::vector<double>{1e-5});
}

TEST(MaterialCardsTest, TakesADensityThatIsTheSameAtAllTemperatures) {
  EXPECT_EQ(material("*DENSITY\n7.8e-9, 0.\n7.8e-9, 2000.\n").density, 7.8e-9);
}

TEST(MaterialCardsTest, ReadsRowsOfSeveralLines) {
  const deck::Material wood =
      material("*ELASTIC, TYPE=ORTHO\n1, 2, 3, 4, 5, 6, 7, 8\n9, 20.\n1, 2, 3, 4, 5, 6, 7, 8\n"
               "10, 30.\n*EXPANSION, TYPE=ORTHO\n1, 2, 3, 20\n");
  EXPECT_EQ(wood.elastic->kind, Kind::orthotropic);
  ASSERT_EQ(wood.elastic->rows.size(), 2u);
  EXPECT_EQ(wood.elastic->rows[1].constants, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 10}));
  EXPECT_EQ(wood.elastic->rows[1].temperature, 30);
  EXPECT_EQ(wood.expansion->rows[0].coefficients, (std::vector<double>{1, 2, 3}));
  const deck::Material crystal =
      material("*ELASTIC, TYPE=ANISO\n1,2,3,4,5,6,7,8\n9,10,11,12,13,14,15,16\n17,18,19,20,21\n");
  EXPECT_EQ(crystal.elastic->kind, Kind::anisotropic);
  ASSERT_EQ(crystal.elastic->rows[0].constants.size(), 21u);
  EXPECT_EQ(crystal.elastic->rows[0].constants[20], 21);
}

/// λ + 2μ, λ and μ are what an isotropic material has as an orthotropic one.
TEST(MaterialCardsTest, TurnsEngineeringConstantsIntoStiffness) {
  const deck::Material iron =
      material("*ELASTIC, TYPE=ENGINEERING CONSTANTS\n200, 200, 200, .25, .25, .25, 80, 80\n80\n");
  EXPECT_EQ(iron.elastic->kind, Kind::orthotropic);
  const std::vector<double> expected{240, 80, 240, 80, 80, 240, 80, 80, 80};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(iron.elastic->rows[0].constants[i], expected[i], 1e-10) << i;
}

/// D times the compliances 1/E and −ν/E is the identity.
TEST(MaterialCardsTest, InvertsTheCompliances) {
  const std::vector<double> d =
      material("*ELASTIC, TYPE=ENGINEERING CONSTANTS\n12., 9., 6., .4, .3, .2, 7, 7\n6\n")
          .elastic->rows[0]
          .constants;
  const double stiffness[3][3] = {{d[0], d[1], d[3]}, {d[1], d[2], d[4]}, {d[3], d[4], d[5]}};
  const double c12 = -0.4 / 12, c13 = -0.3 / 12, c23 = -0.2 / 9;
  const double compliance[3][3] = {{1. / 12, c12, c13}, {c12, 1. / 9, c23}, {c13, c23, 1. / 6}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double product = 0;
      for (int k = 0; k < 3; ++k)
        product += stiffness[i][k] * compliance[k][j];
      EXPECT_NEAR(product, i == j ? 1 : 0, 1e-13) << i << j;
    }
}

TEST(MaterialCardsTest, RefusesWrongConstants) {
  expectSays(refusalWith("*MATERIAL, NAME=m\n*ELASTIC\n210000\n"), {"line 12", "value 2", "left out"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*ELASTIC\n1, .5\n"), {"line 11: *ELASTIC", "Poisson's ratio"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*ELASTIC\n1, .3\n1, .3, 0\n"),
             {"line 11", "temperatures", "row 2"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*ELASTIC, TYPE=ORTHO\n1, 2, 3, 4, 5, 6, 7, 8\n"),
             {"line 11", "missing"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*ELASTIC, TYPE=LAMINA\n1\n"), {"line 11", "LAMINA"});
  expectSays(refusalWith("*ELASTIC\n1, .3\n"), {"line 10", "*MATERIAL"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*MATERIAL, NAME=M\n"), {"line 11", "line 10"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*DENSITY\n1\n2, 50.\n"),
             {"line 11: *DENSITY", "depends on temperature"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*ELASTIC\n1, .3\n*PLASTIC\n1, 0\n"),
             {"line 13: *PLASTIC: ", "linearly elastic"});
}

TEST(MaterialCardsTest, ReadsSectionsThatNameWhatComesLater) {
  const deck::Deck deck =
      withTetrahedron("*SOLID SECTION, ELSET=Eall, MATERIAL=m, ORIENTATION=o\n2.,\n"
                      "*MATERIAL, NAME=m\n*ORIENTATION, NAME=o, SYSTEM=CYLINDRICAL\n"
                      "0, 0, 0, 0, 0, 1\n3, 30.\n*MEMBRANE, ELSET=none, MATERIAL=m\n1.\n");
  ASSERT_EQ(deck.sections.size(), 1u);
  EXPECT_EQ(deck.sections[0].elementSet, "EALL");
  EXPECT_EQ(deck.sections[0].thickness, 2);
  const deck::Orientation& orientation = deck.orientations.at("O");
  EXPECT_TRUE(orientation.isCylindrical);
  EXPECT_EQ(orientation.b, (Point{0, 0, 1}));
  EXPECT_EQ(orientation.rotationAxis, 3);
  EXPECT_EQ(orientation.rotationAngle, 30);
  ASSERT_EQ(deck.ignored.size(), 1u);
  EXPECT_EQ(deck.ignored[0].keyword, "*MEMBRANE without elements");
}

TEST(MaterialCardsTest, RefusesSectionsOfWhatIsNotThere) {
  expectSays(refusalWith("*MATERIAL, NAME=steel\n*SOLID SECTION, ELSET=Eall, MATERIAL=stel\n"),
             {"line 11: *SOLID SECTION: ", "no material \"STEL\"", "did you mean \"STEEL\"?"});
  expectSays(refusalWith("*MATERIAL, NAME=m\n*SOLID SECTION, ELSET=Eal, MATERIAL=m\n"),
             {"line 11", "did you mean \"EALL\"?"});
  expectSays(refusalWith("*SHELL SECTION, ELSET=Eall, MATERIAL=m\n1.\n"), {"line 10", "*SOLID SECTION"});
}

} // namespace
