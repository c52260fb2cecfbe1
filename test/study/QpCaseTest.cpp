#include "QpCase.hpp"
#include "QpTraffic.hpp"

#include "epafi/base/Errors.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <utility>

namespace {

using namespace epafi;
using drivers::QpCase;

QpCase smallCase(const char* problem) {
  QpCase row;
  row.problem = problem;
  row.size = 31; // two meshes for the nested start
  return row;
}

TEST(QpCaseTest, EveryStartAndPreconditionerEndsAtTheSameMinimum) {
  QpCase row = smallCase("torsion");
  const double minimum = drivers::solveCase(row, Tpetra::getDefaultComm()).report.objective;
  for (const auto& [start, preconditioner] :
       {std::pair{"zero", "multigrid"}, {"unconstrained", "none"}, {"nested", "face_multigrid"}}) {
    row.start = start;
    row.preconditioner = preconditioner;

    const qp::SolveReport report = drivers::solveCase(row, Tpetra::getDefaultComm()).report;

    EXPECT_EQ(report.status, qp::Status::converged) << start << ": " << report.reason;
    EXPECT_NEAR(report.objective, minimum, 1e-8 * std::abs(minimum)) << start;
  }
}

TEST(QpCaseTest, CountsTheProductsOfTheStart) {
  QpCase row = smallCase("torsion");
  EXPECT_EQ(drivers::solveCase(row, Tpetra::getDefaultComm()).startMultiplications, 0);

  row.start = "nested";
  const drivers::QpResult nested = drivers::solveCase(row, Tpetra::getDefaultComm());

  QpCase coarse = row; // 15 × 15 unknowns from 0, norm estimate included
  coarse.size = 15;
  coarse.start = "zero";
  const drivers::QpResult coarseResult = drivers::solveCase(coarse, Tpetra::getDefaultComm());
  const int products = coarseResult.report.counts.hessianMultiplications + coarseResult.normMultiplications;
  EXPECT_NEAR(nested.startMultiplications, products * 225.0 / 961.0, 1e-9);
  EXPECT_LE(nested.startSeconds, nested.seconds);
}

TEST(QpCaseTest, NamesMethods) {
  QpCase row;
  EXPECT_EQ(methodName(row), "projected_cg");
  row.expansion = "fixed step";
  EXPECT_EQ(methodName(row), "fixed_step");
}

TEST(QpCaseTest, RefusesAnUnknownProblem) {
  EXPECT_THROW(drivers::solveCase(smallCase("bearing"), Tpetra::getDefaultComm()), InputError);
}

TEST(QpTrafficTest, GivesRatesThatMakeSense) {
  std::istringstream table(drivers::measureTraffic(true, Tpetra::getDefaultComm()).csv());
  std::string line;
  std::getline(table, line);
  ASSERT_EQ(line, "size,bytes_per_step,step_seconds,stream_bytes_per_second,ratio");
  int rows = 0;
  double size = 0, bytes = 0, seconds = 0, stream = 0, ratio = 0;
  char comma = 0;
  while (table >> size >> comma >> bytes >> comma >> seconds >> comma >> stream >> comma >> ratio) {
    EXPECT_EQ(bytes, 26 * 8 * size) << "23 vectors read, 3 written";
    EXPECT_NEAR(ratio, bytes / seconds / stream, 1e-3 * ratio);
    EXPECT_GT(ratio, 0);
    ++rows;
  }
  EXPECT_EQ(rows, 2);
}

} // namespace
