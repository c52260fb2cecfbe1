#include "Decks.hpp"

#include "epafi/deck/Cards.hpp"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace {

using namespace epafi;
using namespace epafi::test;

const std::filesystem::path suite = "/usr/share/doc/calculix-ccx-test/examples/test";

/// A line of decks.txt.
struct SuiteDeck {
  std::string name;
  std::string word; ///< that the refusal names; empty if the deck is read
  int numSteps = 0, numElements = 0, numNodes = 0;
};

std::vector<SuiteDeck> suiteDecks() {
  std::ifstream table(EPAFI_SOURCE_DIR "/test/deck/decks.txt");
  std::vector<SuiteDeck> decks;
  for (std::string line; std::getline(table, line);) {
    if (line.starts_with('#'))
      continue;
    std::istringstream words(line);
    SuiteDeck deck;
    std::string verdict;
    words >> deck.name >> verdict;
    if (verdict == "refuses")
      words >> deck.word;
    else
      words >> deck.numSteps >> deck.numElements >> deck.numNodes;
    EXPECT_TRUE(words) << line;
    decks.push_back(deck);
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
      std::size_t numElements = 0;
      std::set<GlobalOrdinal> nodes;
      for (const deck::Elements& elements : deck.elements) {
        numElements += elements.numbers.size();
        nodes.insert(elements.nodes.begin(), elements.nodes.end());
      }
      EXPECT_EQ(std::ssize(nodes), suiteDeck.numNodes) << suiteDeck.name;
      EXPECT_EQ(numElements, suiteDeck.numElements) << suiteDeck.name;
      EXPECT_EQ(std::ssize(deck.steps), suiteDeck.numSteps) << suiteDeck.name;
      EXPECT_FALSE(deck.sections.empty()) << suiteDeck.name;
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
