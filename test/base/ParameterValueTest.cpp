#include "epafi/base/ParameterValue.hpp"

#include "support/Refusal.hpp"

#include <Teuchos_Array.hpp>

namespace {

using namespace epafi;
using test::expectSays;
using test::refusal;
using Teuchos::getValue;

std::string refusalOf(const std::string& type, const std::string& text) {
  return refusal([&] { parseValue(type, text); });
}

TEST(ParameterValueTest, ReadsBackWhatItWrites) {
  for (const auto& [type, text] :
       std::vector<std::pair<std::string, std::string>>{{"int", "-7"},
                                                        {"double", "0.1"},
                                                        {"double", "1e-300"},
                                                        {"double", "0.30000000000000004"},
                                                        {"bool", "true"},
                                                        {"Array(int)", "{4, 4}"},
                                                        {"Array(double)", "{0, 1.5, -2}"},
                                                        {"Array(int)", "{}"}}) {
    const auto entry = parseValue(type, text);
    EXPECT_EQ(typeName(entry), type);
    EXPECT_EQ(valueText(entry), text);
  }
}

TEST(ParameterValueTest, AllowsBlanksAndAPlusSign) {
  EXPECT_EQ(getValue<double>(parseValue("double", " +1.5e3\n")), 1500.0);
  EXPECT_EQ(getValue<int>(parseValue("int", " 12 ")), 12);
  EXPECT_EQ(valueText(parseValue("Array(double)", " { 1 ,2 } ")), "{1, 2}");
}

TEST(ParameterValueTest, KeepsATextAsItIs) {
  EXPECT_EQ(getValue<std::string>(parseValue("string", " two  words ")), " two  words ");
  EXPECT_EQ(getValue<std::string>(parseValue("string", "")), "");
}

TEST(ParameterValueTest, RefusesWhatIsNotCompletelyANumber) {
  for (const char* const text : {"abc", "1,5", "1.5x", "", " ", "1 2", "+-1", "0x10", "1e", "--1"})
    expectSays(refusalOf("double", text), {"is not a number"});
  for (const char* const text : {"2.5", "1e3", "seven", "", "4 4", "{4}"})
    expectSays(refusalOf("int", text), {"is not a whole number"});
}

TEST(ParameterValueTest, RefusesWhatIsNotFiniteOrDoesNotFit) {
  for (const char* const text : {"nan", "inf", "-Infinity", "NaN"})
    expectSays(refusalOf("double", text), {"is not a finite number"});
  expectSays(refusalOf("double", "1e999"), {"too large"});
  expectSays(refusalOf("int", "2147483648"), {"too large"});
}

TEST(ParameterValueTest, RefusesWordsThatAreNeitherTrueNorFalse) {
  for (const char* const text : {"yes", "1", "True", ""})
    expectSays(refusalOf("bool", text), {"neither true nor false"});
}

TEST(ParameterValueTest, RefusesWordsLongerThanAnyPath) {
  const std::string longest(1 << 20, 'x');
  EXPECT_EQ(getValue<std::string>(parseValue("string", longest)), longest);
  expectSays(refusalOf("string", longest + 'x'), {"more than 1048576 letters"});
}

TEST(ParameterValueTest, ShowsTheBeginningOfLongValues) {
  EXPECT_EQ(valueText(Teuchos::ParameterEntry(Teuchos::Array<int>(1000, 1))).size(), 203U);
  std::string list(1002, 'x');
  list.front() = '{';
  list.back() = '}';
  EXPECT_LT(refusalOf("Array(int)", list).size(), 300U);
}

TEST(ParameterValueTest, NamesTheEntryOfAnArrayThatIsWrong) {
  expectSays(refusalOf("Array(int)", "{4, 4.5}"), {"entry 2", "\"4.5\"", "not a whole number"});
  expectSays(refusalOf("Array(double)", "{0, nan}"), {"entry 2", "\"nan\"", "not a finite number"});
  expectSays(refusalOf("Array(double)", "{1, }"), {"entry 2", "\"\""});
  expectSays(refusalOf("Array(double)", "{{1}, 2}"), {"entry 1", "\"{1}\""});
  for (const char* const text : {"1, 2", "{1, 2", "1, 2}", "", "}"})
    expectSays(refusalOf("Array(double)", text), {"is not an array"});
}

} // namespace
