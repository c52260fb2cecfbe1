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

Row someRow(int ranks) {
  Row row = scalingRun("coercive", 8, 16, ranks);
  row["hessian_multiplications"] = 40;
  row["solve_seconds"] = 0.128;
  return row;
}

TEST(ScalingTableTest, ReadsWhatItWrites) {
  Table table = scalingTable();
  table.rows = {someRow(1), someRow(2)};

  const Table read = readScaling(TemporaryFile(table.csv()).path, 0);

  EXPECT_EQ(read.csv(), table.csv());
  ASSERT_EQ(read.rows.size(), 2);
  EXPECT_EQ(read.rows[0].number("solve_seconds"), 0.128);
  EXPECT_TRUE(std::isnan(read.rows[0].number("energy"))) << "was not measured";
}

TEST(ScalingTableTest, KeepsRowsOfOtherNumbersOfRanks) {
  Table table = scalingTable();
  table.rows = {someRow(1), someRow(2)};

  const Table read = readScaling(TemporaryFile(table.csv()).path, 2);

  EXPECT_NE(read.find(someRow(1), scalingSettings), nullptr);
  EXPECT_EQ(read.find(someRow(2), scalingSettings), nullptr);
}

TEST(ScalingTableTest, RefusesOtherTables) {
  EXPECT_THROW(readScaling(TemporaryFile("problem,size\ntorsion,100\n").path, 1), InputError);
  EXPECT_TRUE(readScaling("no such file", 1).rows.empty());
}

TEST(ScalingSeriesTest, RunsNothingTwice) {
  for (const bool quick : {true, false}) {
    const std::vector<Row> runs = runsOnOneRank(ScalingSizes(quick));
    for (std::size_t i = 0; i < runs.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_FALSE(runs[i].isLike(runs[j], scalingSettings)) << i << ' ' << j;
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
  const auto half = comm->split(comm->getRank() % 2, 0);
  sumOverRanks(*half, 1.0);
  const MessageCounts ofTeam = messageCounts() - before - counts;
  EXPECT_EQ(ofTeam.reductions, comm->getSize() == 1 ? 1 : 0);
  EXPECT_EQ(ofTeam.teamReductions, half->getSize() > 1 ? 1 : 0);
}

/// Ten subdomains have ten crosspoints and as many motions; factors cost as their size.
Table linearCosts(const std::string& problem) {
  Table coarse("");
  for (const char* kind : {"crosspoints", "motions"})
    for (const double n : {100.0, 1000.0})
      coarse.rows.push_back({{"problem", problem},
                             {"kind", kind},
                             {"subdomains", n},
                             {"unknowns", n},
                             {"solve_seconds", 1e-8 * n},
                             {"factor_bytes", 100 * n}});
  return coarse;
}

TEST(RankPredictionTest, TheCoarseProblemOfFetiDpTakesOver) {
  const LocalWork local = LocalWork::of(someRow(1));
  const std::vector<Row> steps = predictSteps(local, linearCosts("coercive"), {16}).rows;

  // 40 products in 0.128 s with 128 subdomains: 25 µs a product and subdomain.
  EXPECT_NEAR(steps[0].number("local_seconds"), 16 * 25e-6, 1e-12);
  EXPECT_GT(steps[0].number("efficiency"), 0.99);
  EXPECT_EQ(steps[5].text("method"), "feti-dp");
  EXPECT_NEAR(steps[5].number("coarse_unknowns"), 1.6e6, 1);
  EXPECT_NEAR(steps[5].number("coarse_solve_seconds"), 1.6e-2, 1e-9) << "as n";
  EXPECT_NEAR(steps[5].number("bytes_a_rank"), 1.6e6 * (100 + 16), 1);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_LT(steps[i].number("efficiency"), steps[i - 1].number("efficiency"));
    EXPECT_GT(steps[i].number("coarse_share"), steps[i - 1].number("coarse_share"));
  }
}

TEST(RankPredictionTest, ClustersHaveMotionsAndRanksRowsOfTheirInverse) {
  LocalWork local = LocalWork::of(someRow(1));
  local.stream = 1e10;
  for (const auto& [problem, modes] : {std::pair{"coercive", 1}, {"blocks", 6}}) {
    local.problem = problem;
    const Table steps = predictSteps(local, linearCosts(problem), {64});
    const auto at = [&](const char* method) {
      const Row* row = steps.find({{"method", method}, {"ranks", 1e4}}, {"method", "ranks"});
      EXPECT_NE(row, nullptr);
      return *row;
    };
    EXPECT_EQ(at("feti-1").number("coarse_unknowns"), modes * 64e4);
    for (const char* method : {"hybrid", "hybrid-spread"}) {
      EXPECT_EQ(at(method).number("coarse_unknowns") * at(method).number("cluster_ranks"), modes * 1e4);
      EXPECT_GT(at(method).number("efficiency"), at("feti-1").number("efficiency"));
      EXPECT_LT(at(method).number("bytes_a_rank"), at("feti-dp").number("bytes_a_rank"));
    }
  }
}

TEST(DualCostTimesTest, BlocksThatAreSlowerNeverPayOff) {
  EXPECT_EQ(payoffOf({3, 1, 8}), 4);
  EXPECT_TRUE(std::isinf(payoffOf({1, 1, 8})));
}

} // namespace
