#include "epafi/base/EvenShares.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <numeric>

namespace epafi {
namespace {

TEST(EvenSharesTest, AreEvenAndInTheOrderOfTheRanks) {
  const auto comm = Tpetra::getDefaultComm();
  for (const int number : {0, 1, 7, 12}) {
    const EvenShares shares(comm, number);
    EXPECT_EQ(sumBefore(*comm, shares.size()), shares.first());
    EXPECT_EQ(sumOverRanks(*comm, shares.size()), number);
    EXPECT_LE(maxOverRanks(*comm, shares.size()), minOverRanks(*comm, shares.size()) + 1);
    std::vector<double> mine(shares.size()), all(static_cast<std::size_t>(number), -1), expected(all);
    std::iota(mine.begin(), mine.end(), shares.first());
    std::iota(expected.begin(), expected.end(), 0);
    shares.gather(mine, all);
    EXPECT_EQ(all, expected);
  }
}

} // namespace
} // namespace epafi
