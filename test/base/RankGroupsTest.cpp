#include "epafi/base/RankGroups.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace epafi {
namespace {

TEST(RankGroupsTest, AreRunsOfRanksAsLargeAsEachOtherAndTheirFirstLead) {
  const RCP<const Comm> all = rcp(new Teuchos::MpiComm<int>(MPI_COMM_WORLD));
  const int ranks = all->getSize();
  for (int number = 1; number <= ranks + 1; ++number) {
    const RankGroups groups(all, number);
    EXPECT_EQ(groups.number(), std::min(number, ranks));
    const std::vector<int> members = gatherOnAll(*groups.group(), std::array{all->getRank()});
    EXPECT_EQ(members.back() - members.front() + 1, static_cast<int>(members.size()));
    EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
    EXPECT_GE(static_cast<int>(members.size()), ranks / groups.number());
    EXPECT_LE(static_cast<int>(members.size()), ranks / groups.number() + 1);
    EXPECT_EQ(groups.leads(), all->getRank() == members.front());
    ASSERT_EQ(groups.leaders().is_null(), !groups.leads());
    EXPECT_EQ(groups.leads() ? groups.leaders()->getSize() : groups.number(), groups.number());
  }
}

} // namespace
} // namespace epafi
