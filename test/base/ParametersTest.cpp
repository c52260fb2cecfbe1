#include "epafi/base/Parameters.hpp"

#include "support/Arrays.hpp"
#include "support/Refusal.hpp"

#include <Teuchos_XMLParameterListHelpers.hpp>

#include <limits>
#include <sstream>

namespace {

using namespace epafi;
using test::counts;
using test::expectSays;
using test::numbers;
using test::refusal;
using Teuchos::Array;
using Teuchos::ParameterList;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();

ParameterList schema() {
  ParameterList list;
  list.set("Title", "", "A few words.");
  ParameterList& solver = list.sublist("Solver", false, "How to solve.");
  addReal(solver, "Tolerance", 1e-6, "Where to stop.", 0.0, 1.0, true);
  addRealOrWord(solver, "Limit", 0.5, {"balanced"}, "A number, or what suits.", 0.0, 1.0);
  addShare(solver, "Share", 0.0, "How much.");
  addReal(solver, "Shift", 0.0, "Any real number.");
  addInteger(solver, "Steps", 100, "How many steps.", 1, 1000);
  addReal(solver, "Factor", 0.5, "Between the two.", 0.0, 2.0, true, true);
  addChoice(solver, "Method", "", "Which method.", {"mprgp", "smalbe"});
  solver.set("Verbose", false, "Whether to talk.");
  addArray(solver, "Range", numbers({}), "Two numbers.", "a < b");
  ParameterList& body = list.sublist("Bodies").sublist("<body>", false, "One body.");
  addReal(body, "Conductivity", 1.0, "Material.", 0.0, infinity, true);
  ParameterList& support = body.sublist("Supports").sublist("<support>", false, "One support.");
  addChoice(support, "Edge", "", "Which edge.", {"left", "right"});
  addArray(support, "Nodes", counts({}), "Which nodes.", "each ≥ 1");
  addReal(support, "Value", 1.0, "How high.");
  setRequired(support, {"Edge", "Nodes", "Value"});
  return list;
}

template <class Value>
std::string refusalOfSolver(const std::string& name, const Value& value) {
  ParameterList given;
  given.sublist("Solver").set(name, value);
  return refusal([&] { validated(given, schema(), "a.xml"); });
}

TEST(ParametersTest, FillsInDefaultsAndMarksThemSo) {
  const ParameterList list = validated(ParameterList(), schema(), "a.xml");
  EXPECT_EQ(list.sublist("Solver").get<double>("Tolerance"), 1e-6);
  EXPECT_EQ(list.sublist("Solver").get<int>("Steps"), 100);
  EXPECT_TRUE(list.sublist("Solver").getEntry("Steps").isDefault());
  EXPECT_EQ(list.sublist("Bodies").numParams(), 0);
}

TEST(ParametersTest, KeepsWhatIsGivenInItsOrder) {
  ParameterList given;
  for (const char* const name : {"zeta", "alpha", "mu"})
    given.sublist("Bodies").sublist(name);
  given.sublist("Solver").set("Steps", 7);
  const ParameterList list = validated(given, schema(), "a.xml");
  EXPECT_EQ(list.sublist("Solver").get<int>("Steps"), 7);
  EXPECT_FALSE(list.sublist("Solver").getEntry("Steps").isDefault());
  std::string order;
  for (auto body = list.sublist("Bodies").begin(); body != list.sublist("Bodies").end(); ++body)
    order += list.sublist("Bodies").name(body) + ' ';
  EXPECT_EQ(order, "zeta alpha mu ");
  EXPECT_EQ(list.sublist("Bodies").sublist("alpha").get<double>("Conductivity"), 1.0);
}

TEST(ParametersTest, ChangesNothingWhenAppliedTwice) {
  ParameterList given;
  given.sublist("Bodies").sublist("left").set("Conductivity", 2.0);
  const ParameterList once = validated(given, schema(), "a.xml"), twice = validated(once, schema(), "a.xml");
  EXPECT_TRUE(Teuchos::haveSameValues(once, twice));
  EXPECT_TRUE(twice.sublist("Solver").getEntry("Tolerance").isDefault());
}

TEST(ParametersTest, GivesAListThatTeuchosCanWrite) {
  std::ostringstream out;
  EXPECT_NO_THROW(Teuchos::writeParameterListToXmlOStream(validated(ParameterList(), schema(), ""), out));
  EXPECT_NE(out.str().find("Tolerance"), std::string::npos);
}

TEST(ParametersTest, TakesWholeNumbersForRealOnes) {
  ParameterList given;
  given.sublist("Solver").set("Shift", 3).set("Range", counts({1, 2}));
  const ParameterList list = validated(given, schema(), "a.xml");
  EXPECT_EQ(list.sublist("Solver").get<double>("Shift"), 3.0);
  EXPECT_EQ(list.sublist("Solver").get<Array<double>>("Range"), numbers({1.0, 2.0}));
}

TEST(ParametersTest, TakesAWordForANumberWhereItMeansOne) {
  ParameterList given;
  given.sublist("Solver").set("Limit", std::string("balanced")).set("Share", std::string("2.5 %"));
  const ParameterList list = validated(given, schema(), "a.xml");
  EXPECT_EQ(list.sublist("Solver").get<std::string>("Limit"), "balanced");
  EXPECT_EQ(list.sublist("Solver").get<double>("Share"), 0.025);
  EXPECT_EQ(validated(list, schema(), "a.xml").sublist("Solver").get<std::string>("Limit"), "balanced");
  given.sublist("Solver").set("Limit", 0.25).set("Share", 0.1);
  EXPECT_EQ(validated(given, schema(), "a.xml").sublist("Solver").get<double>("Limit"), 0.25);
  EXPECT_EQ(validated(given, schema(), "a.xml").sublist("Solver").get<double>("Share"), 0.1);
}

TEST(ParametersTest, RefusesOtherWordsAndNumbersThere) {
  const std::string limit = "> 0 and ≤ 1, or \"balanced\"",
                    share = "≥ 0 and < 1, or per cents such as \"1 %\"";
  expectSays(refusalOfSolver("Limit", std::string("ballanced")), {"\"Limit\"", "\"ballanced\"", limit});
  expectSays(refusalOfSolver("Limit", 0.0), {"\"Limit\"", limit});
  for (const char* const wrong : {"100 %", "-1 %", "1", "% 1", "one %", "nan %"})
    expectSays(refusalOfSolver("Share", std::string(wrong)), {"\"Share\"", wrong, share});
  expectSays(refusalOfSolver("Share", 1.0), {"\"Share\"", share});
}

TEST(ParametersTest, RefusesAnUnknownParameterAndSuggestsTheNearest) {
  expectSays(refusalOfSolver("Tolerence", 1e-3),
             {"a.xml: ", "\"Tolerence\"", "list \"Solver\"", "0.001", "did you mean \"Tolerance\"?"});
}

TEST(ParametersTest, ListsWhatIsAllowedWhereNoNameIsNear) {
  expectSays(refusalOfSolver("Xqwzj", 1), {"a.xml: ", "\"Xqwzj\"", "list \"Solver\"",
                                           "\"Tolerance\", \"Limit\", \"Share\", \"Shift\", \"Steps\""});
}

TEST(ParametersTest, RefusesAnUnknownListAndSuggestsTheNearest) {
  ParameterList given;
  given.sublist("Bodys");
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
             {"a.xml: ", "list \"Bodys\"", "the top list", "did you mean \"Bodies\"?"});
}

TEST(ParametersTest, NamesTheWholePathOfAList) {
  ParameterList given;
  given.sublist("Bodies").sublist("left").set("Conductivity", -1.0);
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
             {"a.xml: ", "parameter \"Conductivity\" in list \"Bodies/left\" is -1, but must be > 0."});
}

TEST(ParametersTest, RefusesAParameterWhereListsOfTheUsersAreExpected) {
  ParameterList given;
  given.sublist("Bodies").set("left", 1);
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
             {"a.xml: ", "\"left\"", "list \"Bodies\"", "one for each <body>"});
}

TEST(ParametersTest, RefusesAListWhereAParameterIsExpected) {
  ParameterList given;
  given.sublist("Solver").sublist("Steps");
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
             {"a.xml: ", "\"Steps\" in list \"Solver\" is a list", "type int"});
}

TEST(ParametersTest, RefusesAParameterWhereAListIsExpected) {
  ParameterList given;
  given.set("Solver", "fast");
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
             {"a.xml: ", "\"Solver\" in the top list is a parameter", "\"fast\"", "must be a list"});
}

TEST(ParametersTest, RefusesAnotherType) {
  expectSays(refusalOfSolver("Steps", 2.5),
             {"a.xml: ", "\"Steps\"", "\"Solver\"", "2.5 of type double", "type int"});
  expectSays(refusalOfSolver("Steps", true), {"true of type bool", "type int"});
  expectSays(refusalOfSolver("Tolerance", "1e-3"), {"\"1e-3\" of type string", "type double"});
  expectSays(refusalOfSolver("Verbose", 1), {"1 of type int", "type bool"});
  expectSays(refusalOfSolver("Range", 1.0), {"1 of type double", "type Array(double)"});
  expectSays(refusalOfSolver("Method", 3), {"3 of type int", "type string"});
}

TEST(ParametersTest, RefusesValuesOutOfRange) {
  expectSays(refusalOfSolver("Tolerance", 0.0),
             {"a.xml: ", "\"Tolerance\"", "\"Solver\"", "is 0", "> 0 and ≤ 1"});
  expectSays(refusalOfSolver("Tolerance", 1.5), {"is 1.5", "> 0 and ≤ 1"});
  expectSays(refusalOfSolver("Factor", 0.0), {"is 0", "> 0 and < 2"});
  expectSays(refusalOfSolver("Factor", 2.0), {"is 2", "> 0 and < 2"});
  expectSays(refusalOfSolver("Steps", 0), {"is 0", "≥ 1 and ≤ 1000"});
  expectSays(refusalOfSolver("Steps", -2147483647), {"is -2147483647", "≥ 1 and ≤ 1000"});
}

TEST(ParametersTest, RefusesWhatIsNotFinite) {
  expectSays(refusalOfSolver("Tolerance", notANumber),
             {"a.xml: ", "\"Tolerance\"", "\"Solver\"", "nan", "finite"});
  expectSays(refusalOfSolver("Shift", notANumber), {"nan", "finite"});
  expectSays(refusalOfSolver("Shift", -infinity), {"-inf", "finite"});
  expectSays(refusalOfSolver("Range", numbers({0.0, notANumber})), {"{0, nan}", "finite"});
}

TEST(ParametersTest, RefusesAWordThatIsNoChoice) {
  expectSays(refusalOfSolver("Method", "mprpg"), {"a.xml: ", "\"Method\"", "\"Solver\"", "is \"mprpg\"",
                                                  "one of \"mprgp\", \"smalbe\"", "did you mean \"mprgp\"?"});
}

TEST(ParametersTest, RefusesListNamesThatCannotNameAGroupOfAFile) {
  for (const char* const name : {"", ".", "a/b"}) {
    ParameterList given;
    given.sublist("Bodies").sublist(name);
    expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
               {"a.xml: ", "list \"Bodies\"", "<body>", "\"/\""});
  }
}

TEST(ParametersTest, RefusesThePatternItselfAsAMisspeltName) {
  ParameterList given;
  given.sublist("<Solver>");
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
             {"\"<Solver>\"", "did you mean \"Solver\"?"});
}

/// A list with one complete support, on which `change` works.
template <class Change>
ParameterList withSupport(const Change& change) {
  ParameterList given;
  ParameterList& support = given.sublist("Bodies").sublist("left").sublist("Supports").sublist("wall");
  support.set("Edge", "left").set("Nodes", counts({1, 2})).set("Value", 0.0);
  change(support);
  return given;
}

TEST(ParametersTest, RefusesAListWithoutARequiredParameter) {
  const ParameterList whole = withSupport([](ParameterList&) {});
  EXPECT_NO_THROW(validated(whole, schema(), "a.xml"));
  for (const char* const name : {"Edge", "Nodes", "Value"}) {
    const ParameterList given = withSupport([&](ParameterList& support) { support.remove(name); });
    expectSays(
        refusal([&] { validated(given, schema(), "a.xml"); }),
        {"a.xml: list \"Bodies/left/Supports/wall\" lacks", '"' + std::string(name) + '"', "must be given."});
  }
}

TEST(ParametersTest, TakesAnEmptyWordOrArrayForNotGiven) {
  ParameterList given = withSupport([](ParameterList& support) { support.set("Edge", ""); });
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }), {"lacks", "\"Edge\" of type string"});
  given = withSupport([](ParameterList& support) { support.set("Nodes", counts({})); });
  expectSays(refusal([&] { validated(given, schema(), "a.xml"); }),
             {"lacks", "\"Nodes\" of type Array(int)"});
}

TEST(ParametersTest, LetsAPartOfAListLackWhatIsRequired) {
  const ParameterList given = withSupport([](ParameterList& support) { support.remove("Value"); });
  EXPECT_NO_THROW(validated(given, schema(), "a.xml", Completeness::part));
}

TEST(ParametersTest, ChecksTheRangeOfARequiredParameter) {
  const ParameterList given = withSupport([](ParameterList& support) { support.set("Edge", "lfet"); });
  const std::string message = refusal([&] { validated(given, schema(), "a.xml"); });
  expectSays(message, {"\"Edge\"", "one of \"left\", \"right\"", "did you mean \"left\"?"});
  EXPECT_TRUE(message.ends_with('?')) << message;
}

TEST(ParametersTest, DescribesEveryParameterForPeople) {
  const std::string text = describeParameters(schema(), "What there is.");
  EXPECT_TRUE(text.starts_with("# Parameters\n\nWhat there is.\n\n| Parameter")) << text;
  EXPECT_TRUE(text.ends_with(" |\n")) << text;
  EXPECT_EQ(text.find("\n\n\n"), std::string::npos) << text;
  for (const char* const part :
       {"\n\n## `Solver`\n\nHow to solve.\n\n| Parameter", "## `Bodies/<body>`",
        "| Tolerance | double | `1e-06` | > 0 and ≤ 1 | Where to stop. |",
        "| Factor | double | `0.5` | > 0 and < 2 | Between the two. |",
        "| Steps | int | `100` | ≥ 1 and ≤ 1000 | How many steps. |",
        "| Range | Array(double) | `{}` | a < b |",
        "| Edge | string | required | one of \"left\", \"right\" | Which edge. |",
        "| Nodes | Array(int) | required | each ≥ 1 | Which nodes. |",
        "| Value | double | required |  | How high. |", "one of \"mprgp\", \"smalbe\"", "One body."})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
}

} // namespace
