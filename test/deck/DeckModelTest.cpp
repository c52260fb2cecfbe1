// What becomes of a deck: bodies, groups and parameters, as a scene's file would have them.

#include "Decks.hpp"

#include "epafi/deck/DeckMesh.hpp"
#include "epafi/deck/DeckModel.hpp"

#include <Teuchos_Array.hpp>

#include <algorithm>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

/// Two cubes of one element each on top of each other; `upper` numbers the upper one's four lower nodes.
std::string cubes(const std::string& upper, const std::string& more) {
  return "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
         "15,0,0,1\n16,1,0,1\n17,1,1,1\n18,0,1,1\n25,0,0,2\n26,1,0,2\n27,1,1,2\n28,0,1,2\n"
         "*ELEMENT,TYPE=C3D8,ELSET=EALL\n1,1,2,3,4,5,6,7,8\n2," +
         upper +
         ",25,26,27,28\n"
         "*NSET,NSET=FOOT\n1,2,3,4\n*NSET,NSET=HEAD\n25,26,27,28\n"
         "*MATERIAL,NAME=M\n*ELASTIC\n200.,.3\n*DENSITY\n2.\n*SOLID SECTION,ELSET=EALL,MATERIAL=M\n" +
         more;
}
const std::string apart = "15,16,17,18", joined = "5,6,7,8";
const std::string oneStep = "*STEP\n*STATIC\n*END STEP\n";

deck::DeckModel modelOf(const std::string& text) {
  return deck::modelOf(deck::parseDeck(text, "a.inp"), "a.inp");
}
ParameterList& bodyOf(deck::DeckModel& model, int number) {
  return model.scene.sublist("Bodies").sublist("body " + std::to_string(number));
}
std::string refusalOf(const std::string& text) {
  try {
    modelOf(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(DeckModelTest, BodiesAreWhatHangsTogetherByFaces) {
  EXPECT_EQ(modelOf(cubes(joined, oneStep)).nodeNumbers.size(), 1u);
  const deck::DeckModel two = modelOf(cubes(apart, oneStep));
  ASSERT_EQ(two.nodeNumbers.size(), 2u);
  EXPECT_EQ(two.nodeNumbers[1], (std::vector<GlobalOrdinal>{15, 16, 17, 18, 25, 26, 27, 28}));
  EXPECT_EQ(two.elementNumbers[1], std::vector<GlobalOrdinal>{2});
}

/// Of one order, and bricks and prisms integrated alike: C3D6 by fewer points, of which C3D8 have no way.
TEST(DeckModelTest, ABodyHasElementsOfSeveralShapes) {
  const std::string prism = "*NODE\n30,2,0,0\n31,2,0,1\n*ELEMENT,TYPE=C3D6,ELSET=EALL\n3,2,30,3,6,31,7\n";
  deck::DeckModel model = modelOf(cubes(joined, prism + oneStep + "*SURFACE,NAME=SIDE\n3,S3\n3,S1\n1,S1\n"));
  ASSERT_EQ(model.nodeNumbers.size(), 1u);
  EXPECT_EQ(model.elementNumbers[0], (std::vector<GlobalOrdinal>{1, 2, 3}));
  EXPECT_EQ(bodyOf(model, 1).get<std::string>("Integration"), "reduced");
  EXPECT_TRUE(model.notes.empty());
  const std::string text =
      deck::mshText(deck::parseDeck(cubes(joined, prism + oneStep), "a.inp"), model.groups);
  EXPECT_NE(text.find("\n3 2 30 3 6 31 7\n"), std::string::npos) << text;
}

const std::string top = "*NODE\n99,.5,.5,7.\n*SURFACE,NAME=TOP\n2,S2\n";
const std::string coupling =
    top + "*COUPLING,CONSTRAINT NAME=C,REF NODE=99,SURFACE=TOP\n*DISTRIBUTING\n1,6\n";
std::string stepWith(const std::string& cards) {
  return "*STEP\n*STATIC\n" + cards + "*END STEP\n";
}

TEST(DeckModelTest, AForceAndAMomentOnANodeAreSpreadOverItsSurface) {
  deck::DeckModel model = modelOf(cubes(joined, coupling + stepWith("*CLOAD\n99,1,3.\n99,3,-2.\n99,5,4.\n")));
  const ParameterList& load = bodyOf(model, 1).sublist("Loads").sublist("step 1 load 1");
  EXPECT_EQ(load.get<std::string>("Kind"), "distributed");
  EXPECT_EQ(load.get<std::string>("Surface"), "TOP");
  EXPECT_EQ(load.get<Teuchos::Array<double>>("Force"), Teuchos::Array<double>(std::vector<double>{3, 0, -2}));
  EXPECT_EQ(load.get<Teuchos::Array<double>>("Moment"), Teuchos::Array<double>(std::vector<double>{0, 4, 0}));
  EXPECT_EQ(load.get<Teuchos::Array<double>>("Point"),
            Teuchos::Array<double>(std::vector<double>{.5, .5, 7}));
  EXPECT_EQ(model.groups.surfaces.at("TOP").size(), 1u);
}

TEST(DeckModelTest, AForceOnANodeIsSharedByWeights) {
  deck::DeckModel model = modelOf(cubes(
      joined, top + "*ELEMENT,TYPE=DCOUP3D,ELSET=E\n9,99\n*DISTRIBUTING COUPLING,ELSET=E\n25,3.\n26,1.\n" +
                  stepWith("*CLOAD\n99,2,8.\n")));
  const ParameterList& loads = bodyOf(model, 1).sublist("Loads");
  std::vector<double> forces;
  for (const char* const name : {"step 1 load 1", "step 1 load 2"})
    forces.push_back(loads.sublist(name).get<Teuchos::Array<double>>("Force")[1]);
  std::sort(forces.begin(), forces.end());
  EXPECT_EQ(forces, (std::vector<double>{2, 6}));
}

TEST(DeckModelTest, NodesThatStandForOthersAreForForcesAlone) {
  const auto refused = [](const std::string& model, const std::string& step) {
    return refusalOf(cubes(joined, model + stepWith(step)));
  };
  const std::string weights =
      top + "*ELEMENT,TYPE=DCOUP3D,ELSET=E\n9,99\n*DISTRIBUTING COUPLING,ELSET=E\n25,3.\n";
  expectSays(refused(coupling, "*BOUNDARY\n99,1,3\n"), {"node 99", "stands for others"});
  expectSays(refused(coupling, "*CLOAD\n25,4,1.\n"), {"component is 4", "no moments"});
  expectSays(refused(weights, "*CLOAD\n99,4,1.\n"), {"forces alone", "*COUPLING and *DISTRIBUTING"});
  expectSays(refused(coupling + "*COUPLING,REF NODE=99,SURFACE=TOP\n*DISTRIBUTING\n", ""),
             {"node 99 stands for other nodes already"});
  expectSays(refused(top + "*COUPLING,REF NODE=99,SURFACE=TOP\n", ""), {"*COUPLING", "behind it belongs"});
  expectSays(refused(top + "*COUPLING,REF NODE=98,SURFACE=TOP\n*DISTRIBUTING\n", ""), {"98", "no node"});
  expectSays(refused(top + "*COUPLING,REF NODE=99,SURFACE=TOB\n*DISTRIBUTING\n", ""), {"TOB"});
  expectSays(refused(top + "*DISTRIBUTING\n1,3\n", ""), {"*DISTRIBUTING", "behind *COUPLING"});
  expectSays(refused(top + "*COUPLING,REF NODE=99,SURFACE=TOP\n*KINEMATIC\n1,3\n", ""), {"*KINEMATIC"});
}

TEST(DeckModelTest, NodesThatBodiesShareAreJoinedByEquations) {
  // One edge in common: no face.
  deck::DeckModel model = modelOf(cubes("5,6,17,18", oneStep));
  ASSERT_EQ(model.nodeNumbers.size(), 2u);
  const ParameterList& equations = model.scene.sublist("Equations");
  EXPECT_EQ(equations.numParams(), 6);
  EXPECT_EQ(equations.sublist("node 5 of bodies 1 and 2 X").get<std::string>("Terms"),
            "1 body 1/node 5/X, -1 body 2/node 5/X, ");
}

TEST(DeckModelTest, SupportsOfEqualValuesAreOne) {
  deck::DeckModel model =
      modelOf(cubes(joined, "*BOUNDARY\nFOOT,1,3\n*STEP\n*STATIC\n*BOUNDARY\nHEAD,3,3,-0.25\n*END STEP\n"));
  const ParameterList& supports = bodyOf(model, 1).sublist("Supports");
  ASSERT_EQ(supports.numParams(), 4); // x, y, z below; z above
  int atHead = 0;
  for (auto entry = supports.begin(); entry != supports.end(); ++entry) {
    ParameterList list = Teuchos::getValue<ParameterList>(supports.entry(entry));
    if (list.isParameter("Z") && list.get<double>("Z") == -0.25) {
      ++atHead;
      EXPECT_EQ(model.groups.surfaces.at(list.get<std::string>("Surface")),
                (std::vector<std::pair<GlobalOrdinal, int>>{{2, 2}}));
    }
  }
  EXPECT_EQ(atHead, 1);
}

TEST(DeckModelTest, StepsReplaceForcesAndAStepAddsUpItsOwn) {
  deck::DeckModel model =
      modelOf(cubes(joined, "*BOUNDARY\nFOOT,1,3\n"
                            "*STEP\n*STATIC\n*CLOAD\n25,3,1.\n25,3,2.\n26,3,5.\n*END STEP\n"
                            "*STEP\n*STATIC\n*CLOAD\n25,3,7.\n*END STEP\n"
                            "*STEP\n*STATIC\n*CLOAD,OP=NEW\n27,3,9.\n*END STEP\n"));
  std::map<std::string, std::vector<std::pair<double, std::vector<GlobalOrdinal>>>> found; // by step
  const ParameterList& loads = bodyOf(model, 1).sublist("Loads");
  for (auto entry = loads.begin(); entry != loads.end(); ++entry) {
    ParameterList load = Teuchos::getValue<ParameterList>(loads.entry(entry));
    found[loads.name(entry).substr(0, 6)].emplace_back(
        load.get<Teuchos::Array<double>>("Force")[2],
        model.groups.nodes.at(load.get<std::string>("Surface")));
  }
  using Forces = std::vector<std::pair<double, std::vector<GlobalOrdinal>>>;
  EXPECT_EQ(found["step 1"], (Forces{{3, {25}}, {5, {26}}}));
  EXPECT_EQ(found["step 2"], (Forces{{5, {26}}, {7, {25}}}));
  EXPECT_EQ(found["step 3"], (Forces{{9, {27}}}));
  EXPECT_NE(
      model.scene.sublist("Steps").sublist("step 2").get<std::string>("Loads").find("step 1 load 1 = 0"),
      std::string::npos);
}

TEST(DeckModelTest, AmplitudesCountAtTheEndOfAStep) {
  deck::DeckModel model =
      modelOf(cubes(joined, "*AMPLITUDE,NAME=A\n0.,0.,4.,2.\n*BOUNDARY\nFOOT,1,3\n"
                            "*STEP\n*STATIC\n1.,1.\n*CLOAD,AMPLITUDE=A\n25,3,10.\n*END STEP\n"));
  const ParameterList& loads = bodyOf(model, 1).sublist("Loads");
  ParameterList load = Teuchos::getValue<ParameterList>(loads.entry(loads.begin()));
  EXPECT_EQ(load.get<Teuchos::Array<double>>("Force")[2], 5.0); // half of 2 after 1 of 4
}

TEST(DeckModelTest, AUsersAmplitudeIsTheSquareOfTimeAndSaysSo) {
  deck::DeckModel model =
      modelOf(cubes(joined, "*AMPLITUDE,NAME=QUADRATIC,USER\n*BOUNDARY\nFOOT,1,3\n"
                            "*STEP\n*STATIC\n1.,30.\n*CLOAD,AMPLITUDE=QUADRATIC\n25,3,10.\n*END STEP\n"));
  const ParameterList& loads = bodyOf(model, 1).sublist("Loads");
  ParameterList load = Teuchos::getValue<ParameterList>(loads.entry(loads.begin()));
  EXPECT_EQ(load.get<Teuchos::Array<double>>("Force")[2], 9000.0);
  EXPECT_NE(model.notes.at(0).find("square of time"), std::string::npos);
}

TEST(DeckModelTest, WeightAndRotationHaveTheDensity) {
  deck::DeckModel model = modelOf(cubes(
      joined,
      "*STEP\n*STATIC\n*DLOAD\nEALL,GRAV,10.,0.,0.,-1.\nEALL,CENTRIF,9.,0.,0.,0.,0.,0.,1.\n*END STEP\n"));
  ParameterList& loads = bodyOf(model, 1).sublist("Loads");
  EXPECT_EQ(loads.sublist("step 1 load 2").get<double>("Value"), 18.0);
  EXPECT_EQ(loads.sublist("step 1 load 1").get<Teuchos::Array<double>>("Force")[2], -20.0);
  EXPECT_FALSE(loads.sublist("step 1 load 2").isParameter("Group")) << "the whole body";
}

TEST(DeckModelTest, ContactsHaveTheLawOfTheirInteraction) {
  const std::string pair = "*SURFACE,NAME=LOW\n1,S2\n*SURFACE,NAME=HIGH\n2,S1\n"
                           "*CONTACT PAIR,INTERACTION=I,TYPE=SURFACE TO SURFACE,ADJUST=0.1\nHIGH,LOW\n"
                           "*SURFACE INTERACTION,NAME=I\n";
  deck::DeckModel model = modelOf(cubes(
      apart, pair + "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n1e4,\n*FRICTION\n0.25,500.\n" + oneStep));
  ParameterList& soft = model.scene.sublist("Contact").sublist("HIGH - LOW");
  EXPECT_EQ(soft.get<std::string>("First Body"), "body 2");
  EXPECT_EQ(soft.get<double>("Stiffness"), 1e4);
  EXPECT_EQ(soft.get<double>("Friction"), 0.25);
  EXPECT_EQ(soft.get<double>("Stick Slope"), 500.0);
  EXPECT_EQ(soft.get<double>("Adjust"), 0.1);
  deck::DeckModel tied = modelOf(cubes(
      apart, pair + "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=TIED\n1e4,\n*FRICTION\n0.25,500.\n" + oneStep));
  ParameterList& bond = tied.scene.sublist("Contact").sublist("HIGH - LOW");
  EXPECT_EQ(bond.get<std::string>("Kind"), "tied");
  EXPECT_EQ(bond.get<double>("Stiffness"), 1e4);
  EXPECT_EQ(bond.get<double>("Stick Slope"), 500.0);
  EXPECT_FALSE(bond.isParameter("Friction"));
  EXPECT_NE(refusalOf(cubes(apart, pair + "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=TIED\n1e4,\n" + oneStep))
                .find("TIED needs a stick slope"),
            std::string::npos);
  deck::DeckModel hard =
      modelOf(cubes(apart, pair + "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=HARD\n" + oneStep));
  EXPECT_FALSE(hard.scene.sublist("Contact").sublist("HIGH - LOW").isParameter("Stiffness"));
  EXPECT_EQ(hard.groups.surfaces.at("HIGH"), (std::vector<std::pair<GlobalOrdinal, int>>{{2, 1}}));
}

TEST(DeckModelTest, SupportsAndPairsComeAndGoWithSteps) {
  deck::DeckModel model = modelOf(
      cubes(apart, "*SURFACE,NAME=LOW\n1,S2\n*SURFACE,NAME=HIGH\n2,S1\n*SURFACE INTERACTION,NAME=I\n"
                   "*CONTACT PAIR,INTERACTION=I,TYPE=SURFACE TO SURFACE\nHIGH,LOW\n*BOUNDARY\nFOOT,1\n"
                   "*STEP\n*STATIC\n*END STEP\n"
                   "*STEP\n*STATIC\n*MODEL CHANGE,TYPE=CONTACT PAIR,REMOVE\nHIGH,LOW\n"
                   "*BOUNDARY,OP=NEW\nHEAD,1,1,0.5\n*END STEP\n"
                   "*STEP\n*STATIC\n*BOUNDARY,FIXED\nHEAD,1\n*END STEP\n"));
  const auto step = [&](int number, const char* parameter) {
    return model.scene.sublist("Steps")
        .sublist("step " + std::to_string(number))
        .get<std::string>(parameter, "");
  };
  EXPECT_EQ(step(1, "Supports"), "body 1/support 1 = 1, body 2/support 1 = off, ");
  EXPECT_EQ(step(2, "Contacts"), "HIGH - LOW = off, ");
  EXPECT_EQ(step(3, "Contacts"), "");
  EXPECT_NE(step(2, "Supports").find("body 1/support 1 = off, body 2/support 1 = 1"), std::string::npos);
  EXPECT_NE(step(3, "Supports").find("body 2/support 1 = fixed"), std::string::npos);
}

TEST(DeckModelTest, ABoltIsCutAtItsSectionAndTightenedStepByStep) {
  deck::DeckModel model =
      modelOf(cubes(joined, "*SURFACE,NAME=LOW\n1,S2\n*PRE-TENSION SECTION,SURFACE=LOW,NODE=15\n0.,0.,2.\n"
                            "*STEP\n*STATIC\n*CLOAD\n15,1,7.\n*END STEP\n"
                            "*STEP\n*STATIC\n*BOUNDARY,FIXED\n15,1\n*END STEP\n"
                            "*STEP\n*STATIC\n*BOUNDARY\n15,1,1,.25\n*END STEP\n"));
  ParameterList& bolt = model.scene.sublist("Contact").sublist("bolt LOW");
  EXPECT_EQ(bolt.get<std::string>("First Body"), "body 1");
  EXPECT_EQ(bolt.get<std::string>("Second Body"), "body 2");
  EXPECT_EQ(bolt.get<std::string>("Preload"), "force 7");
  EXPECT_EQ(bolt.get<Teuchos::Array<double>>("Preload Direction").toVector(), (std::vector<double>{0, 0, 2}));
  for (const auto& [step, preload] :
       {std::pair("step 2", "bolt LOW = locked, "), std::pair("step 3", "bolt LOW = shortening 0.25, ")})
    EXPECT_EQ(model.scene.sublist("Steps").sublist(step).get<std::string>("Preload"), preload);
  EXPECT_FALSE(model.scene.isSublist("Equations")) << "the nodes in between are joined by the bolt alone";
  EXPECT_EQ(model.nodeNumbers[0], (std::vector<GlobalOrdinal>{1, 2, 3, 4, 29, 30, 31, 32}));
}

TEST(DeckModelTest, SaysByLineWhatIsNotSolved) {
  for (const auto& [more, part] :
       {std::pair("", "no *STEP"),
        std::pair("*STEP\n*STATIC\n*CLOAD\n15,1,1.\n*END STEP\n",
                  "line 34: *CLOAD: node 15 belongs to no element"),
        std::pair("*STEP\n*STATIC\n*BOUNDARY,FIXED\nFOOT,1\n*END STEP\n", "FIXED holds what a step before"),
        std::pair("*SURFACE,NAME=SIDE\n1,S3\n*PRE-TENSION SECTION,SURFACE=SIDE,NODE=15\n1.,0.,0.\n*STEP\n"
                  "*STATIC\n*END STEP\n",
                  "do not part one body"),
        std::pair("*EQUATION\n2\n1,1,1.,15,1,-1.\n*STEP\n*STATIC\n*END STEP\n",
                  "node 15 belongs to no element")})
    EXPECT_NE(refusalOf(cubes(joined, more)).find(part), std::string::npos) << refusalOf(cubes(joined, more));
}

TEST(DeckModelTest, AHeldSideOfAPrismIsAFacetOfFourNodes) {
  const deck::Deck deck =
      deck::parseDeck("*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n4,0.,0.,1.\n5,1.,0.,1.\n6,0.,1.,1.\n"
                      "*ELEMENT,TYPE=C3D6,ELSET=ALL\n1,1,2,3,4,5,6\n*MATERIAL,NAME=M\n*ELASTIC\n200.,.3\n"
                      "*SOLID SECTION,ELSET=ALL,MATERIAL=M\n*NSET,NSET=SIDE\n1,2,4,5\n*BOUNDARY\nSIDE,1,3\n" +
                          oneStep,
                      "a.inp");
  const std::string text = mshText(deck, deck::modelOf(deck, "a.inp").groups);
  EXPECT_NE(text.find("\n2 1 3 1\n2 1 4 5 2\n"), std::string::npos) << text;
}

TEST(DeckModelTest, TheMeshHasTheNumbersOfTheDeckAndItsGroups) {
  const deck::Deck deck = deck::parseDeck(cubes(joined, "*BOUNDARY\nFOOT,1,3\n" + oneStep), "a.inp");
  const deck::DeckModel model = deck::modelOf(deck, "a.inp");
  const std::string text = mshText(deck, model.groups);
  for (const char* const part :
       {"$MeshFormat\n4.1 0 8\n", "3 1 \"body 1\"\n", "2 1 \"body 1 support 1\"\n",
        "\n2 5 6 7 8 25 26 27 28\n", "1 12 1 28\n"}) // nodes 15 to 18 are of no element
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
}

} // namespace
