#include "DualCostTimes.hpp"
#include "MessageCounts.hpp"
#include "RankPrediction.hpp"
#include "ScalingSeries.hpp"
#include "ScalingTable.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

namespace {

using namespace epafi;
using namespace epafi::drivers;

/// A file of this rank alone, removed at the end.
class TemporaryFile {
public:
  explicit TemporaryFile(const std::string& text)
      : path(std::filesystem::temp_directory_path() /
             ("epafi_scaling_" + std::to_string(getpid()) + ".csv")) {
    std::ofstream(path) << text;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::filesystem::path path;
};

ScalingRow someRow(double ranks) {
  ScalingRow row;
  row.subdomainsPerSide = 8;
  row.elementsPerSide = 16;
  row.ranks = ranks;
  row.hessianMultiplications = 40;
  row.solve = 0.128;
  return row;
}

TEST(ScalingTableTest, ReadsWhatItWrites) {
  ScalingTable table;
  table.add(someRow(2));
  table.add(someRow(1));

  const ScalingTable read(TemporaryFile(table.csv()).path);

  EXPECT_EQ(read.csv(), table.csv());
  ASSERT_EQ(read.rows().size(), 2);
  EXPECT_EQ(read.rows()[0].ranks, 1) << "few ranks first";
  EXPECT_EQ(read.rows()[0].solve, 0.128);
  EXPECT_TRUE(std::isnan(read.rows()[0].energy)) << "was not measured";
}

TEST(ScalingTableTest, KeepsRowsOfOtherNumbersOfRanks) {
  ScalingTable table;
  table.add(someRow(1));
  table.add(someRow(2));

  table.removeRanks(2);

  EXPECT_NE(table.find(someRow(1)), nullptr);
  EXPECT_EQ(table.find(someRow(2)), nullptr);
}

TEST(ScalingTableTest, RefusesOtherTables) {
  EXPECT_THROW(ScalingTable(TemporaryFile("problem,size\ntorsion,100\n").path), InputError);
  EXPECT_TRUE(ScalingTable("no such file").rows().empty());
}

TEST(ScalingSeriesTest, RunsNothingTwice) {
  for (const bool quick : {true, false}) {
    const std::vector<ScalingRow> runs = runsOnOneRank(ScalingSizes(quick));
    for (std::size_t i = 0; i < runs.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_FALSE(runs[i].isSameRun(runs[j])) << i << ' ' << j;
  }
}

TEST(MessageCountsTest, CountsSumsOverTheRanks) {
  const auto comm = Tpetra::getDefaultComm();
  const MessageCounts before = messageCounts();

  sumOverRanks(*comm, 1.0);

  const MessageCounts counts = messageCounts() - before;
  EXPECT_EQ(counts.messages, 0);
  if (comm->getSize() > 1) {
    EXPECT_EQ(counts.reductions, 1);
    EXPECT_EQ(counts.reductionBytes, 8);
  }
}

TEST(RankPredictionTest, TheCoarseProblemTakesOver) {
  const std::vector<CoarseTimes> coarse{{100, 0, 1e-6, 1e4}, {1000, 0, 1e-5, 1e5}};

  const std::vector<PredictedStep> steps = predictSteps(someRow(1), coarse, {16});

  // 40 products in 0.128 s with 128 subdomains: 25 µs a product and subdomain.
  EXPECT_NEAR(steps.front().local, 16 * 25e-6, 1e-12);
  EXPECT_GT(steps.front().efficiency(), 0.99);
  EXPECT_NEAR(steps.back().coarseUnknowns, 1.6e6, 1);
  EXPECT_NEAR(steps.back().coarseSolve, 1.6e-2, 1e-9) << "as n";
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LT(steps[i].efficiency(), steps[i - 1].efficiency());
    EXPECT_GT(steps[i].coarseShare(), steps[i - 1].coarseShare());
  }
}

TEST(DualCostTimesTest, BlocksThatAreSlowerNeverPayOff) {
  EXPECT_EQ(DualCostTimes::payoff({3, 1, 8}), 4);
  EXPECT_TRUE(std::isinf(DualCostTimes::payoff({1, 1, 8})));
}

} // namespace
