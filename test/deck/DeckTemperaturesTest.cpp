/// Temperatures of a deck as loads of a scene.

#include "Decks.hpp"

#include "epafi/deck/DeckModel.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

/// A tetrahedron whose material is said more of, then *INITIAL CONDITIONS of 20 and the steps.
deck::DeckModel heated(const std::string& material, const std::string& steps) {
  return deck::modelOf(withTetrahedron("*MATERIAL, NAME=m\n" + material +
                                       "*SOLID SECTION, ELSET=Eall, MATERIAL=m\n"
                                       "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNall, 20.\n" +
                                       steps),
                       "a.inp");
}

std::string step(const std::string& cards) {
  return "*STEP\n*STATIC\n" + cards + "*END STEP\n";
}

const std::string elastic = "*ELASTIC\n200., 0.3\n", constant = elastic + "*EXPANSION\n1.e-5\n";

ParameterList bodyOf(deck::DeckModel& model) {
  return model.scene.sublist("Bodies").sublist("body 1");
}

/// Changes of temperature of each load, and the nodes that have them.
std::map<double, std::vector<GlobalOrdinal>> changesIn(deck::DeckModel& model) {
  std::map<double, std::vector<GlobalOrdinal>> changes;
  ParameterList body = bodyOf(model);
  ParameterList& loads = body.sublist("Loads");
  for (const auto& entry : loads) {
    const ParameterList& load = loads.sublist(entry.first);
    EXPECT_EQ(load.get<std::string>("Kind"), "temperature");
    changes[load.get<double>("Value")] = load.isParameter("Surface")
                                             ? model.groups.nodes.at(load.get<std::string>("Surface"))
                                             : std::vector<GlobalOrdinal>{};
  }
  return changes;
}

TEST(DeckTemperaturesTest, ChangesAreThoseFromTheInitialTemperatures) {
  deck::DeckModel model = heated(constant, step("*TEMPERATURE\nNall, 100.\nbase, 50.\n"));
  EXPECT_EQ(bodyOf(model).get<double>("Expansion"), 1e-5);
  const auto changes = changesIn(model);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes.at(30), (std::vector<GlobalOrdinal>{1, 2, 3}));
  EXPECT_EQ(changes.at(80), std::vector<GlobalOrdinal>{4});
}

TEST(DeckTemperaturesTest, ACoefficientThatChangesHasTheStrainFromItsZero) {
  deck::DeckModel model =
      heated(elastic + "*EXPANSION, ZERO=10.\n1.e-5, 0.\n2.e-5, 100.\n", step("*TEMPERATURE\nNall, 60.\n"));
  EXPECT_EQ(bodyOf(model).get<double>("Expansion"), 1e-5);
  const auto changes = changesIn(model);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_NEAR(changes.begin()->first, (1.6e-5 * 50 - 1.2e-5 * 10) / 1e-5, 1e-12);
  EXPECT_TRUE(changes.begin()->second.empty()) << "all nodes need no name";
}

TEST(DeckTemperaturesTest, ACardReplacesThatOfAnEarlierStepAndNewOnesAllOfThem) {
  deck::DeckModel model =
      heated(constant, step("*TEMPERATURE\nNall, 100.\n") + step("*TEMPERATURE\nbase, 50.\n") +
                           step("*TEMPERATURE, OP=NEW\n4, 70.\n"));
  ParameterList body = bodyOf(model);
  std::map<std::string, double> values;
  for (const auto& entry : body.sublist("Loads"))
    values[entry.first] = body.sublist("Loads").sublist(entry.first).get<double>("Value");
  EXPECT_EQ(values,
            (std::map<std::string, double>{
                {"step 1 load 1", 80}, {"step 2 load 2", 30}, {"step 2 load 3", 80}, {"step 3 load 4", 50}}));
}

TEST(DeckTemperaturesTest, ModuliAreThoseAtTheTemperatureOfTheStep) {
  const std::string changing = "*ELASTIC\n200., 0.3, 0.\n100., 0.3, 100.\n*EXPANSION\n1.e-5\n";
  const auto refused = [&](const std::string& steps) {
    return refusal([&] { (void)heated(changing, steps); });
  };
  deck::DeckModel cold = heated(changing, step(""));
  EXPECT_NEAR(bodyOf(cold).get<double>("Young's Modulus"), 180, 1e-12);
  EXPECT_FALSE(bodyOf(cold).isParameter("Expansion")) << "no temperature changes";
  deck::DeckModel warm = heated(changing, step("*TEMPERATURE\nNall, 60.\n"));
  EXPECT_NEAR(bodyOf(warm).get<double>("Young's Modulus"), 140, 1e-12);
  EXPECT_FALSE(bodyOf(warm).isSublist("Stiffness Factors"));
  expectSays(refused(step("*TEMPERATURE\nNall, 60.\n") + step("*TEMPERATURE\nNall, 70.\n")),
             {"*ELASTIC", "the same temperatures in all steps"});
}

TEST(DeckTemperaturesTest, TemperaturesThatDifferInsideABodyAreFactorsOfItsStiffness) {
  const auto elasticAt = [](const std::string& ratio) {
    return "*ELASTIC\n200., 0.3, 0.\n100., " + ratio + ", 100.\n*EXPANSION\n1.e-5\n";
  };
  const std::string steps = step("*TEMPERATURE\nbase, 60.\n"); // node 4 stays at 20
  deck::DeckModel model = heated(elasticAt("0.3"), steps);
  ParameterList body = bodyOf(model);
  EXPECT_EQ(body.get<double>("Young's Modulus"), 200);
  std::map<double, std::vector<GlobalOrdinal>> factors;
  for (const auto& entry : body.sublist("Stiffness Factors")) {
    const ParameterList& factor = body.sublist("Stiffness Factors").sublist(entry.first);
    factors[factor.get<double>("Value")] = model.groups.nodes.at(factor.get<std::string>("Surface"));
  }
  ASSERT_EQ(factors.size(), 2U);
  EXPECT_NEAR(factors.begin()->first, 0.7, 1e-12);
  EXPECT_EQ(factors.begin()->second, (std::vector<GlobalOrdinal>{1, 2, 3}));
  EXPECT_NEAR(factors.rbegin()->first, 0.9, 1e-12);
  EXPECT_EQ(factors.rbegin()->second, std::vector<GlobalOrdinal>{4});
  expectSays(refusal([&] { (void)heated(elasticAt("0.2"), steps); }), {"*ELASTIC", "Poisson's ratio"});
}

TEST(DeckTemperaturesTest, AMaterialThatExpandsDifferentlyAlongItsAxesIsRefused) {
  const std::string cards = step("*TEMPERATURE\nNall, 60.\n");
  deck::DeckModel even = heated(elastic + "*EXPANSION, TYPE=ORTHO\n1.e-5, 1.e-5, 1.e-5\n", cards);
  EXPECT_EQ(bodyOf(even).get<double>("Expansion"), 1e-5);
  expectSays(refusal([&] { (void)heated(elastic + "*EXPANSION, TYPE=ORTHO\n1.e-5, 2.e-5, 1.e-5\n", cards); }),
             {"*EXPANSION", "along their axes"});
}

} // namespace
