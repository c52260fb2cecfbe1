#include "Decks.hpp"

#include "epafi/deck/Cards.hpp"

#include <filesystem>
#include <fstream>

namespace {

using namespace epafi;
using namespace epafi::test;

const std::filesystem::path suite = "/usr/share/doc/calculix-ccx-test/examples/test";

/// A line of decks.txt: a deck of CalculiX' own suite (Debian's package calculix-ccx-test), and what its refusal
/// names; nothing if it is to be read.
struct SuiteDeck {
  std::string name, word;
};

std::vector<SuiteDeck> suiteDecks() {
  std::ifstream table(EPAFI_SOURCE_DIR "/test/deck/decks.txt");
  std::vector<SuiteDeck> decks;
  for (std::string line; std::getline(table, line);) {
    const std::size_t blank = std::min(line.find(' '), line.size());
    if (!line.starts_with('#'))
      decks.push_back({line.substr(0, blank), line.substr(std::min(blank + 1, line.size()))});
  }
  return decks;
}

std::string fileOf(const SuiteDeck& deck) {
  const std::filesystem::path plain = suite / (deck.name + ".inp");
  return exists(plain) ? plain.string() : plain.string() + ".gz";
}

TEST(SuiteTest, ReadsWhatIsToRun) {
  if (!exists(suite))
    GTEST_SKIP() << "the package calculix-ccx-test is not installed";
  int numRead = 0;
  for (const SuiteDeck& suiteDeck : suiteDecks()) {
    if (!suiteDeck.word.empty())
      continue;
    try {
      const deck::Deck deck = deck::readDeck(fileOf(suiteDeck));
      ++numRead;
      EXPECT_FALSE(deck.nodes.numbers.empty() || deck.elements.empty() || deck.sections.empty())
          << suiteDeck.name;
      EXPECT_FALSE(deck.steps.empty()) << suiteDeck.name;
      for (const deck::Step& step : deck.steps)
        EXPECT_GT(step.period, 0) << suiteDeck.name;
    } catch (const InputError& error) {
      ADD_FAILURE() << suiteDeck.name << ": " << error.what();
    }
  }
  EXPECT_GE(numRead, 79);
}

TEST(SuiteTest, RefusesTheOthersByTheWord) {
  if (!exists(suite))
    GTEST_SKIP() << "the package calculix-ccx-test is not installed";
  int numRefused = 0;
  for (const SuiteDeck& suiteDeck : suiteDecks()) {
    if (suiteDeck.word.empty())
      continue;
    try {
      (void)deck::readDeck(fileOf(suiteDeck));
      ADD_FAILURE() << suiteDeck.name << " is read";
    } catch (const InputError& error) {
      ++numRefused;
      const std::string message = deck::squeezed(error.what());
      EXPECT_NE(message.find(suiteDeck.word), std::string::npos) << suiteDeck.name << ": " << error.what();
      EXPECT_NE(message.find(",LINE"), std::string::npos) << error.what();
    }
  }
  EXPECT_GE(numRefused, 250);
}

} // namespace
