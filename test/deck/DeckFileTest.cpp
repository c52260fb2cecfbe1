#include "Decks.hpp"

#include "support/TemporaryDirectory.hpp"

#include <Tpetra_Core.hpp>
#include <zlib.h>

#include <fstream>

namespace {

using namespace epafi;
using namespace epafi::test;

class DeckFileTest : public ::testing::Test {
protected:
  DeckFileTest() : directory_(Tpetra::getDefaultComm()) {}

  std::string write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = directory_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  std::string writePacked(const std::string& name, const std::string& text) {
    std::string path = (directory_.path() / name).string();
    const gzFile file = gzopen(path.c_str(), "wb");
    EXPECT_EQ(gzwrite(file, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
    EXPECT_EQ(gzclose(file), Z_OK);
    return path;
  }

private:
  TemporaryDirectory directory_;
};

TEST_F(DeckFileTest, ReadsPlainAndPackedFilesAlike) {
  const std::string text = tetrahedron + "*NSET, NSET=more\n4\n";
  for (const std::string& file : {write("a.inp", text), writePacked("b.inp.gz", text)}) {
    const deck::Deck deck = deck::readDeck(file);
    EXPECT_EQ(deck.nodes.numbers.size(), 4u);
    EXPECT_EQ(deck.nodeSets.at("MORE"), std::vector<GlobalOrdinal>{4});
  }
}

TEST_F(DeckFileTest, IncludesFilesOfTheDecksFolderWithTheirOwnLines) {
  write("parts/nodes.inp", "1, 0.\n2, 1.\n");
  write("parts/sets.inp", "*NSET, NSET=A\n1\n*INCLUDE, INPUT=\"parts/more.inp\"\n");
  write("parts/more.inp", "2\n*BOUNDARY\nA, 1\n");
  const deck::Deck deck = deck::readDeck(write(
      "a.inp", "*NODE\n*INCLUDE, INPUT=parts/nodes.inp\n3, 2.\n*INCLUDE, INPUT=parts/sets.inp\n3, 2\n"));
  EXPECT_EQ(deck.nodes.numbers.size(), 3u);
  EXPECT_EQ(deck.nodeSets.at("A"), (std::vector<GlobalOrdinal>{1, 2}));
  ASSERT_EQ(deck.boundaries.size(), 2u);
  EXPECT_EQ(text(deck.boundaries[0].place), "parts/more.inp, line 3");
  EXPECT_EQ(text(deck.boundaries[1].place), "a.inp, line 5");
}

TEST_F(DeckFileTest, RefusesFilesThatAreNotThereOrIncludeThemselves) {
  expectSays(refusal([&] { (void)deck::readDeck("nowhere/a.inp"); }),
             {"\"nowhere/a.inp\"", "does not exist"});
  const std::string missing = write("a.inp", "*INCLUDE, INPUT=none.inp\n");
  expectSays(refusal([&] { (void)deck::readDeck(missing); }), {"a.inp, line 1: *INCLUDE", "none.inp"});
  const std::string circle = write("b.inp", "*INCLUDE, INPUT=c.inp\n");
  write("c.inp", "*NODE\n*INCLUDE, INPUT=b.inp\n");
  expectSays(refusal([&] { (void)deck::readDeck(circle); }), {"c.inp, line 2: *INCLUDE", "includes itself"});
}

TEST_F(DeckFileTest, EndsWhereFilesIncludeOthersOverAndOver) {
  for (int i = 0; i < 14; ++i)
    write(std::to_string(i) + ".inp", "*INCLUDE, INPUT=" + std::to_string(i + 1) +
                                          ".inp\n*INCLUDE, INPUT=" + std::to_string(i + 1) + ".inp\n");
  write("14.inp", "*NODE\n1, 0.\n");
  const std::string file = write("0.inp", "*INCLUDE, INPUT=1.inp\n*INCLUDE, INPUT=1.inp\n");
  expectSays(refusal([&] { (void)deck::readDeck(file); }), {"*INCLUDE", "10000 times"});
}

TEST_F(DeckFileTest, RefusesAPackedFileThatIsCutOff) {
  std::string text = tetrahedron;
  for (int n = 5; n < 5000; ++n)
    text += "*NODE\n" + std::to_string(n) + ", " + std::to_string(n * n % 977) + '\n';
  const std::string file = writePacked("a.inp.gz", text);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  expectSays(refusal([&] { (void)deck::readDeck(file); }), {"a.inp.gz", "cut off"});
}

TEST_F(DeckFileTest, RefusesAFolder) {
  const std::string file = write("folder/a.inp", "");
  expectSays(refusal([&] { (void)deck::readDeck(std::filesystem::path(file).parent_path().string()); }),
             {"cannot be read"});
}

} // namespace
