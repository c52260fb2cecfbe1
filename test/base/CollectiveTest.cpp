#include "epafi/base/Collective.hpp"

#include "support/Refusal.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>

#include <new>
#include <stdexcept>
#include <string>

namespace {

using namespace epafi;

class CollectiveTest : public testing::Test {
protected:
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  int lastRank = comm->getSize() - 1;
};

TEST_F(CollectiveTest, ReturnsWhereNothingFails) {
  int calls = 0;
  collectively(*comm, [&] { ++calls; });
  EXPECT_EQ(calls, 1);
}

TEST_F(CollectiveTest, ThrowsAnInputErrorOfOneRankOnAllRanks) {
  const std::string message = test::refusal([&] {
    collectively(*comm, [&] {
      if (comm->getRank() == lastRank)
        throw InputError("wrong on rank " + std::to_string(lastRank));
    });
  });
  EXPECT_EQ(message, "wrong on rank " + std::to_string(lastRank));
}

TEST_F(CollectiveTest, KeepsTheKindOfASolvabilityError) {
  for (const auto kind : {SolvabilityError::Kind::noSolution, SolvabilityError::Kind::notUnique}) {
    try {
      collectively(*comm, [&] {
        if (comm->getRank() == lastRank)
          throw SolvabilityError(kind, "body right floats");
      });
      FAIL() << "nothing was thrown";
    } catch (const SolvabilityError& error) {
      EXPECT_EQ(error.kind(), kind);
      EXPECT_STREQ(error.what(), "body right floats");
    }
  }
}

TEST_F(CollectiveTest, TurnsOtherExceptionsIntoAnErrorWithTheirText) {
  try {
    collectively(*comm, [&] {
      if (comm->getRank() == lastRank)
        throw std::out_of_range("index 7");
    });
    FAIL() << "nothing was thrown";
  } catch (const InputError&) {
    FAIL() << "not the user's mistake";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "index 7");
  }
}

TEST_F(CollectiveTest, NamesTheRankThatHasNoMemory) {
  try {
    collectively(*comm, [&] {
      if (comm->getRank() == lastRank)
        throw std::bad_alloc();
    });
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    test::expectSays(error.what(),
                     {"rank " + std::to_string(lastRank) + " has no memory left", "more machines"});
  }
}

TEST_F(CollectiveTest, PutsTheTextOfAnExceptionOnOneLine) {
  EXPECT_EQ(sentenceOf(std::runtime_error("\n first\n\n   second line\t \n"), 0), "first second line");
  EXPECT_EQ(sentenceOf(std::runtime_error(""), 0), "");
  test::expectSays(sentenceOf(std::exception(), 3), {"most likely rank 3 has no memory left"});
}

TEST_F(CollectiveTest, NamesTheRankOfAnExceptionThatHasNoText) {
  try {
    collectively(*comm, [&] {
      if (comm->getRank() == lastRank)
        throw 1;
    });
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("rank " + std::to_string(lastRank)), std::string::npos);
  }
}

TEST_F(CollectiveTest, AgreesOnTheLowestRankIfSeveralFail) {
  EXPECT_EQ(test::refusal([&] {
              collectively(*comm, [&] {
                throw InputError(std::string(1000, static_cast<char>('a' + comm->getRank())));
              });
            }),
            std::string(1000, 'a'));
}

TEST_F(CollectiveTest, PassesAnEmptyText) {
  EXPECT_EQ(test::refusal([&] { collectively(*comm, [] { throw InputError(""); }); }), "");
}

TEST_F(CollectiveTest, ReducesOverTheRanks) {
  const double ranks = comm->getSize();
  EXPECT_EQ(sumBefore(*comm, comm->getRank() + GlobalOrdinal{5'000'000'000}),
            comm->getRank() * (comm->getRank() - 1) / 2 + comm->getRank() * GlobalOrdinal{5'000'000'000});
  EXPECT_EQ(sumOverRanks(*comm, 1.0), ranks);
  EXPECT_EQ(sumOverRanks(*comm, GlobalOrdinal{2}), 2 * comm->getSize());
  EXPECT_EQ(maxOverRanks(*comm, 1.0 * comm->getRank()), ranks - 1);
  EXPECT_EQ(minOverRanks(*comm, -1.0 * comm->getRank()), 1 - ranks);
  std::array<double, 2> values = {1, -3};
  sumOverRanks(*comm, values);
  EXPECT_EQ(values[0], ranks);
  EXPECT_EQ(values[1], -3 * ranks);
}

TEST_F(CollectiveTest, ReducesIntegersWithoutRounding) {
  const GlobalOrdinal large = (GlobalOrdinal{1} << 53) + 1; // no double
  EXPECT_EQ(maxOverRanks(*comm, large + comm->getRank()), large + lastRank);
  EXPECT_EQ(minOverRanks(*comm, large + comm->getRank()), large);
  EXPECT_EQ(sumOverRanks(*comm, large), large * comm->getSize());
  std::vector<GlobalOrdinal> several{large, -1};
  sumOverRanks(*comm, several);
  EXPECT_EQ(several, (std::vector<GlobalOrdinal>{large * comm->getSize(), -comm->getSize()}));
  EXPECT_EQ(sumOverRanks(*comm, 3), 3 * comm->getSize());
  EXPECT_EQ(maxOverRanks(*comm, comm->getRank()), lastRank);
  EXPECT_EQ(minOverRanks(*comm, -comm->getRank()), -lastRank);
  std::vector<int> counts{comm->getRank() == lastRank ? 7 : 0};
  sumOverRanks(*comm, counts);
  EXPECT_EQ(counts.front(), 7);
}

TEST_F(CollectiveTest, KnowsWhatHoldsOnOneRank) {
  EXPECT_TRUE(holdsAnywhere(*comm, comm->getRank() == lastRank));
  EXPECT_FALSE(holdsAnywhere(*comm, false));
}

TEST_F(CollectiveTest, GathersUnevenPiecesInTheOrderOfTheRanks) {
  const std::vector<double> mine(comm->getRank(),
                                 comm->getRank()); // none on rank 0
  std::vector<double> expected;
  for (int rank = 0; rank < comm->getSize(); ++rank)
    expected.insert(expected.end(), static_cast<std::size_t>(rank), rank);
  EXPECT_EQ(gatherOnAll(*comm, mine), expected);
  EXPECT_EQ(gatherOnFirst(*comm, mine), comm->getRank() == 0 ? expected : std::vector<double>());
}

/// What two ranks may tell each other: an index and a value.
struct Entry {
  GlobalOrdinal row;
  double value;
  friend bool operator==(const Entry&, const Entry&) = default;
};

TEST_F(CollectiveTest, GathersIndicesAndStructs) {
  const GlobalOrdinal large = (GlobalOrdinal{1} << 53) + 1; // no double
  std::vector<GlobalOrdinal> rows;
  std::vector<Entry> entries;
  for (int rank = 0; rank < comm->getSize(); ++rank) {
    rows.push_back(large + rank);
    entries.push_back({large + rank, 0.5 * rank});
  }
  const std::size_t here = comm->getRank();
  EXPECT_EQ(gatherOnAll(*comm, std::span<const GlobalOrdinal>(rows).subspan(here, 1)), rows);
  EXPECT_EQ(gatherOnAll(*comm, std::array<Entry, 1>{entries[here]}), entries);
  EXPECT_TRUE(gatherOnAll(*comm, std::vector<int>()).empty());
}

} // namespace
