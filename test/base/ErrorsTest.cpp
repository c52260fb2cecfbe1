#include "epafi/base/Errors.hpp"

#include <gtest/gtest.h>

#include <vector>

using epafi::editDistance;
using epafi::nearestName;

TEST(NearestNameTest, CountsSingleLetterEditsAndIgnoresCase) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("", "abc"), 3u);
  EXPECT_EQ(editDistance("Elements", "elements"), 0u);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(editDistance("Gird", "Grid"), 1u) << "neighbours swapped";
  EXPECT_EQ(editDistance("tlef", "left"), 2u);
}

TEST(NearestNameTest, FindsTheNameWithAMissingLetter) {
  const std::vector<std::string> names = {"Rectangle", "Elements", "Conductivity"};
  EXPECT_EQ(nearestName("Elemnts", names), "Elements");
  EXPECT_EQ(nearestName("Elments", names), "Elements");
  EXPECT_EQ(nearestName("conductivty", names), "Conductivity");
  EXPECT_EQ(nearestName("RECTANGLE", names), "Rectangle");
}

TEST(NearestNameTest, AllowsAnEditForAboutEveryThirdLetter) {
  const std::vector<std::string> names = {"x", "left", "Bodies", "Contact"};
  EXPECT_EQ(nearestName("X", names), "x") << "case does not count";
  EXPECT_EQ(nearestName("y", names), "");
  EXPECT_EQ(nearestName("letf", names), "left");
  EXPECT_EQ(nearestName("loft", names), "left");
  EXPECT_EQ(nearestName("soft", names), "");
  EXPECT_EQ(nearestName("Bodys", names), "Bodies");
  EXPECT_EQ(nearestName("Output", names), "");
}

TEST(AsSentenceTest, AddsAFullStopOnlyWhereNothingEndsTheSentence) {
  EXPECT_EQ(epafi::asSentence("it is 1"), "it is 1.");
  EXPECT_EQ(epafi::asSentence("it is so."), "it is so.");
  EXPECT_EQ(epafi::asSentence("did you mean \"left\"?"), "did you mean \"left\"?");
}

TEST(NearestNameTest, SuggestsNothingWhereNothingIsNear) {
  const std::vector<std::string> names = {"Rectangle", "Elements"};
  EXPECT_EQ(nearestName("Zwölf", names), "");
  EXPECT_EQ(nearestName("Gap", std::vector<std::string>()), "");
}

TEST(NearestNameTest, LooksForNoneWhereWordsAreEndless) {
  const std::string endless(5'000'000, 'a');
  EXPECT_EQ(nearestName(endless, std::vector<std::string>{"Rectangle", endless}), "") << "and that soon";
  EXPECT_EQ(nearestName("Rectangel", std::vector<std::string>{endless, "Rectangle"}), "Rectangle");
}

TEST(ShortenedTest, KeepsTheBeginningOfLongTexts) {
  EXPECT_EQ(epafi::shortened(std::string(200, 'x')), std::string(200, 'x'));
  EXPECT_EQ(epafi::shortened(std::string(201, 'x')), std::string(200, 'x').append("..."));
  EXPECT_EQ(epafi::shortened(""), "");
}

TEST(ShortenedTest, CutsBetweenCharacters) {
  std::string letters = "x";
  for (int i = 0; i < 150; ++i)
    letters += "ß"; // two bytes: the 200th byte is the first half of one
  EXPECT_EQ(epafi::shortened(letters), letters.substr(0, 199) + "...");
  EXPECT_EQ(epafi::shortened(std::string(300, '\x80')), "...") << "no UTF-8 at all";
}

TEST(ShortenedTest, ShowsNoControlCharacters) {
  EXPECT_EQ(epafi::shortened("a\n\x1b[31mß"), "a??[31mß");
}
