#include "epafi/scene/ParameterFile.hpp"

#include "support/Arrays.hpp"
#include "support/Refusal.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace {

using namespace epafi;
using scene::parseParameters;
using scene::readParameterFile;
using test::counts;
using test::expectSays;
using test::numbers;
using test::refusal;
using Teuchos::ParameterList;

/// A list "Outer/Inner" around the given elements.
std::string nested(const std::string& elements) {
  return "<ParameterList name=\"Epafi\"><ParameterList name=\"Outer\"><ParameterList name=\"Inner\">" +
         elements + "</ParameterList></ParameterList></ParameterList>";
}

std::string parameter(const std::string& type, const std::string& value) {
  return "<Parameter name=\"p\" type=\"" + type + "\" value=\"" + value + "\"/>";
}

std::string refusalOfText(const std::string& text) {
  return refusal([&] { parseParameters(text, "a.xml"); });
}

TEST(ParameterFileTest, ReadsEveryTypeInTheOrderOfTheFile) {
  const ParameterList list = parseParameters(
      "<?xml version=\"1.0\"?>\n<!-- a comment -->\n<ParameterList name=\"Epafi\">"
      "<Parameter name=\"z\" type=\"int\" value=\"3\"/><Parameter name=\"y\" type=\"double\" value=\"1e-3\"/>"
      "<Parameter name=\"x\" type=\"bool\" value=\"true\"/><Parameter name=\"w\" type=\"string\" "
      "value=\"Επαφή &lt; 1\"/>"
      "<Parameter name=\"v\" type=\"Array(int)\" value=\"{1, 2}\"/>"
      "<Parameter name=\"u\" type=\"Array(double)\" value=\"{0.5}\"/><ParameterList "
      "name=\"t\"/></ParameterList>",
      "a.xml");
  EXPECT_EQ(list.name(), "Epafi");
  EXPECT_EQ(list.get<int>("z"), 3);
  EXPECT_EQ(list.get<double>("y"), 1e-3);
  EXPECT_EQ(list.get<bool>("x"), true);
  EXPECT_EQ(list.get<std::string>("w"), "Επαφή < 1");
  EXPECT_EQ(list.get<Teuchos::Array<int>>("v"), counts({1, 2}));
  EXPECT_EQ(list.get<Teuchos::Array<double>>("u"), numbers({0.5}));
  EXPECT_TRUE(list.isSublist("t"));
  std::string order;
  for (auto entry = list.begin(); entry != list.end(); ++entry)
    order += list.name(entry);
  EXPECT_EQ(order, "zyxwvut");
}

TEST(ParameterFileTest, NamesTheLineOfMalformedXml) {
  expectSays(refusalOfText("<ParameterList>\n<Parameter name=\"x\" type=double/>\n</ParameterList>"),
             {"a.xml, line 2: malformed XML", "quoted"});
  expectSays(refusalOfText("<ParameterList>\n</Foo>"), {"a.xml, line 2: ", "Foo"});
  expectSays(refusalOfText("<ParameterList>"), {"a.xml, line 1: ", "file ended before closing"});
  expectSays(refusalOfText("hello"), {"a.xml, line 1: "});
  expectSays(refusalOfText("<ParameterList/><ParameterList/>"), {"a.xml, line 1: ", "more than one root"});
  expectSays(refusalOfText("<ParameterList>\n\n<!-- open </ParameterList>"), {"a.xml, line 3"});
}

/// As Python's ElementTree writes letters beyond ASCII.
TEST(ParameterFileTest, ReferencesAreTheLettersThatTheyName) {
  for (const auto& [reference, letter] : {std::pair<std::string, std::string>{"&#252;", "ü"},
                                          {"&#xFC;", "ü"},
                                          {"&#8364;", "€"},
                                          {"&#x20ac;", "€"},
                                          {"&#x1F527;", "🔧"},
                                          {"&#60;&lt;&#x3c;", "<<<"}}) {
    const Teuchos::ParameterList list = parseParameters(
        nested("<Parameter name=\"B" + reference + "gel\" type=\"string\" value=\"" + reference + "\"/>"),
        "a.xml");
    EXPECT_EQ(list.sublist("Outer").sublist("Inner").get<std::string>("B" + letter + "gel"), letter);
  }
  for (const std::string wrong : {"&#;", "&#xQ;", "&#252"})
    expectSays(refusalOfText(nested("<Parameter name=\"" + wrong + "\" type=\"int\" value=\"1\"/>")),
               {"a.xml", "malformed XML"});
}

TEST(ParameterFileTest, RefusesATextWithoutXml) {
  for (const std::string text : {"", " \n\t"})
    expectSays(refusalOfText(text), {"a.xml is empty", "<ParameterList>"});
  expectSays(refusalOfText("<!-- nothing -->"), {"a.xml", "<ParameterList>"});
  expectSays(refusalOfText(std::string("\0\1\2", 3)), {"a.xml is a binary file"});
}

TEST(ParameterFileTest, RefusesAnotherRootElement) {
  expectSays(refusalOfText("<Scene/>"), {"a.xml: ", "<Scene>", "<ParameterList>"});
}

TEST(ParameterFileTest, RefusesOtherElements) {
  expectSays(refusalOfText(nested("<Paramter/>")),
             {"a.xml: ", "<Paramter>", "\"Outer/Inner\"", "<Parameter>"});
  expectSays(refusalOfText(nested("some words")), {"a.xml: ", "some words", "\"Outer/Inner\""});
  expectSays(refusalOfText(nested("<Parameter name=\"p\" type=\"int\" value=\"1\"><x/></Parameter>")),
             {"\"p\"", "<x>"});
}

TEST(ParameterFileTest, RefusesAMissingAttribute) {
  expectSays(refusalOfText(nested("<Parameter type=\"int\" value=\"1\"/>")),
             {"a.xml: ", "\"Outer/Inner\"", "no name"});
  expectSays(refusalOfText(nested("<Parameter name=\"p\" value=\"1\"/>")), {"a.xml: ", "\"p\"", "no type"});
  expectSays(refusalOfText(nested("<Parameter name=\"p\" type=\"int\"/>")), {"a.xml: ", "\"p\"", "no value"});
  expectSays(refusalOfText(nested("<ParameterList/>")), {"\"Outer/Inner\"", "no name"});
}

TEST(ParameterFileTest, RefusesAnUnknownType) {
  expectSays(refusalOfText(nested(parameter("dubble", "1"))),
             {"a.xml: ", "\"p\"", "\"Outer/Inner\"", "\"dubble\"",
              "int, double, bool, string, Array(int), Array(double)", "did you mean \"double\"?"});
}

TEST(ParameterFileTest, RefusesARealNumberThatDoesNotParse) {
  for (const std::string value : {"abc", "1,5", "1.5 2.5", "", "1e"})
    expectSays(refusalOfText(nested(parameter("double", value))),
               {"a.xml: ", "\"p\"", "\"Outer/Inner\"", "type double", '"' + value + '"', "is not a number"});
  for (const std::string value : {"nan", "inf", "-inf"})
    expectSays(refusalOfText(nested(parameter("double", value))),
               {"\"p\"", '"' + value + '"', "not a finite number"});
}

TEST(ParameterFileTest, RefusesAWholeNumberThatDoesNotParse) {
  for (const std::string value : {"2.5", "two", "", "3000000000"})
    expectSays(refusalOfText(nested(parameter("int", value))),
               {"a.xml: ", "\"p\"", "\"Outer/Inner\"", "type int", '"' + value + '"', "a whole number"});
}

TEST(ParameterFileTest, RefusesABoolThatDoesNotParse) {
  expectSays(refusalOfText(nested(parameter("bool", "yes"))),
             {"a.xml: ", "\"p\"", "\"yes\"", "true nor false"});
}

TEST(ParameterFileTest, RefusesAnArrayThatDoesNotParse) {
  expectSays(refusalOfText(nested(parameter("Array(double)", "{0, x, 1}"))),
             {"a.xml: ", "\"p\"", "entry 2", "\"x\""});
  expectSays(refusalOfText(nested(parameter("Array(double)", "{0, nan}"))), {"\"p\"", "entry 2", "finite"});
  expectSays(refusalOfText(nested(parameter("Array(int)", "{4, 4.5}"))),
             {"\"p\"", "entry 2", "whole number"});
  expectSays(refusalOfText(nested(parameter("Array(int)", "4, 4"))), {"\"p\"", "\"4, 4\"", "not an array"});
}

TEST(ParameterFileTest, RefusesNamesThatAppearTwice) {
  const std::string one = parameter("int", "1"), list = "<ParameterList name=\"p\"/>";
  for (const std::string& text : {one + one, list + list, one + list})
    expectSays(refusalOfText(nested(text)), {"a.xml: ", "\"p\"", "twice", "\"Outer/Inner\""});
}

/// `number` lists inside the top list.
std::string inside(int number, const std::string& tag = "ParameterList name=\"a\"") {
  std::string text = "<ParameterList>";
  for (int i = 0; i < number; ++i)
    text += '<' + tag + '>';
  for (int i = 0; i < number; ++i)
    text += "</" + tag.substr(0, tag.find(' ')) + '>';
  return text + "</ParameterList>";
}

TEST(ParameterFileTest, RefusesElementsNestedWithoutEndBeforeTheStackOverflows) {
  EXPECT_EQ(parseParameters(inside(99), "a.xml").numParams(), 1);
  for (const int number : {100, 500'000})
    for (const char* const tag : {"ParameterList name=\"a\"", "a", "a b='/>'"})
      expectSays(refusalOfText(inside(number, tag)), {"a.xml nests", "more than 100 deep"});
  const std::string half = inside(100'000);
  expectSays(refusalOfText(half.substr(0, half.find("</"))), {"more than 100 deep"});
}

TEST(ParameterFileTest, CountsNoDepthWhereTagsEndAtOnce) {
  std::string many = "<?xml version=\"1.0\"?><!-- <a> <b> \" --><ParameterList>";
  for (int i = 0; i < 150; ++i)
    many.append("<Parameter name=\">").append(std::to_string(i)).append("'\" type=\"int\" value=\"1\" />");
  EXPECT_EQ(parseParameters(many + "</ParameterList>", "a.xml").numParams(), 150);
}

TEST(ParameterFileTest, RefusesNamesThatNobodyCanRead) {
  const auto named = [](const std::string& name) {
    return nested("<Parameter name=\"" + name + "\" type=\"int\" value=\"1\"/>");
  };
  EXPECT_NO_THROW(parseParameters(named(std::string(200, 'x')), "a.xml"));
  expectSays(refusalOfText(named(std::string(201, 'x'))),
             {"\"Outer/Inner\"", "xxx...\"", "at most 200 letters"});
  expectSays(refusalOfText(named("a\x1b[31m")), {"\"a?[31m\"", "control characters"});
}

TEST(ParameterFileTest, ShowsOnlyTheBeginningOfWhatIsEndless) {
  const std::string endless(1'000'000, 'x');
  for (const std::string& text :
       {nested(parameter(endless, "1")), nested(parameter("int", endless)), nested(endless),
        nested('<' + endless + "/>"), '<' + endless + "/>", '<' + endless})
    EXPECT_LT(refusalOfText(text).size(), 1000U);
}

/// A file that rank 0 alone writes, under a name that no other run of this test uses.
class ParameterFileOnDiskTest : public testing::Test {
protected:
  void TearDown() override {
    comm->barrier();
    if (comm->getRank() == 0)
      std::filesystem::remove(path);
  }
  void write(const std::string& text) const {
    if (comm->getRank() == 0)
      std::ofstream(path, std::ios::binary) << text;
  }

  RCP<const Comm> comm = Tpetra::getDefaultComm();
  // Ranks other than 0 have another process id, thus another path, which must not matter.
  std::string path =
      (std::filesystem::temp_directory_path() / ("epafi_parameters_" + std::to_string(getpid()) + ".xml"))
          .string();
};

TEST_F(ParameterFileOnDiskTest, ReachesAllRanksThoughOneReadsIt) {
  write(nested(parameter("double", "0.5")));
  const ParameterList list = readParameterFile(path, *comm);
  EXPECT_EQ(list.sublist("Outer").sublist("Inner").get<double>("p"), 0.5);
}

TEST_F(ParameterFileOnDiskTest, RefusesWrongContentOnAllRanksNamingTheFile) {
  write(nested(parameter("double", "abc")));
  expectSays(refusal([&] { readParameterFile(path, *comm); }), {"epafi_parameters_", ".xml: ", "\"abc\""});
}

TEST_F(ParameterFileOnDiskTest, RefusesAnEmptyFileOnAllRanks) {
  write("");
  expectSays(refusal([&] { readParameterFile(path, *comm); }), {"epafi_parameters_", "is empty"});
}

TEST_F(ParameterFileOnDiskTest, RefusesAMissingFileOnAllRanks) {
  expectSays(refusal([&] { readParameterFile(path, *comm); }), {"epafi_parameters_", "does not exist"});
  expectSays(refusal([&] { readParameterFile("", *comm); }), {"does not exist"});
}

TEST_F(ParameterFileOnDiskTest, RefusesADirectoryOnAllRanks) {
  expectSays(refusal([&] { readParameterFile("/tmp", *comm); }), {"/tmp is a directory"});
}

} // namespace
