/// Observers that end an iteration, or look at it.

#include "FaultyOperators.hpp"
#include "QpProblems.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/qp/solve/ConjugateGradient.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

/// Wants to stop at one step and to look at another, on the last rank alone.
class LastRankOnly final : public qp::Observer {
public:
  int stopAt = std::numeric_limits<int>::max(), lookAt = std::numeric_limits<int>::max();
  int steps = 0, looks = 0;
  Eigen::VectorXd seen;

  void step(const qp::StepRecord& /*record*/) override { ++steps; }
  bool wantsToStop() override { return isHere_ && steps >= stopAt; }
  bool wantsToLook() override { return isHere_ && steps >= lookAt && looks == 0; }
  void look(const Vector& x) override {
    ++looks;
    seen = gather(x); // a message: all ranks must be here
  }

private:
  bool isHere_ = Tpetra::getDefaultComm()->getRank() == Tpetra::getDefaultComm()->getSize() - 1;
};

void expectSameOnAllRanks(int value) {
  const Comm& comm = *Tpetra::getDefaultComm();
  EXPECT_EQ(maxOverRanks(comm, value), minOverRanks(comm, value));
}

/// With equality constraints SMALBE solves it, else MPRGP.
class InterruptionTest : public testing::TestWithParam<bool> {
protected:
  DenseProgram program = GetParam() ? mixedProgramWithRows(30, 3, 1e6, 79) : mixedProgram(30, 1e6, 79);
  LastRankOnly observer;
  QpCall call{withTolerance(1e-12), {}, &observer};
};

TEST_P(InterruptionTest, OneRankStopsAllAtTheSameStep) {
  for (const int stopAt : {0, 1, 5, 12}) {
    observer = {};
    observer.stopAt = stopAt;

    const QpAnswer answer = solveQp(program, call);

    EXPECT_EQ(answer.report.status, Status::interrupted) << answer.report.reason;
    EXPECT_NE(answer.report.reason.find("asked to stop"), std::string::npos) << answer.report.reason;
    EXPECT_LE(observer.steps, stopAt + 1);
    expectSameOnAllRanks(observer.steps);
    EXPECT_LE(residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>()).feasibility,
              0);
  }
}

TEST_P(InterruptionTest, TheRunGoesOnFromWhereItStopped) {
  const QpAnswer whole = solveQp(program, call);
  ASSERT_EQ(whole.report.status, Status::converged);
  observer = {};
  observer.stopAt = static_cast<int>(whole.report.history.size()) / 2;
  const QpAnswer half = solveQp(program, call);
  ASSERT_EQ(half.report.status, Status::interrupted);
  observer = {};
  call.start = half.x;

  const QpAnswer rest = solveQp(program, call);

  EXPECT_EQ(rest.report.status, Status::converged);
  EXPECT_EQ(whyNoSolution(program, rest, 1e-12), "");
  EXPECT_LE((rest.x - whole.x).norm(), 1e-5 * whole.x.norm()) << "condition 1e6, tolerance 1e-12";
}

TEST_P(InterruptionTest, OneRankMakesAllLookAtTheIterate) {
  for (const int place : {0, 3, 9}) {
    observer = {};
    observer.lookAt = observer.stopAt = place; // what it sees is the last iterate

    const QpAnswer answer = solveQp(program, call);

    EXPECT_EQ(observer.looks, 1);
    EXPECT_EQ(observer.seen, answer.x);
  }
}

INSTANTIATE_TEST_SUITE_P(BoundsAndRows, InterruptionTest, testing::Bool());

/// In the middle of a prediction, which may take hundreds of products, the wish is heard as well.
TEST(PredictionInterruptionTest, DoesNotWaitForThePredictionsEnd) {
  const DenseProgram program = mixedProgram(60, 1e8, 5);
  LastRankOnly observer;
  QpCall call{withTolerance(1e-13), {}, &observer};
  call.parameters.sublist("MPRGP").set("Expansion", "active set");
  const QpAnswer whole = solveQp(program, call);
  int longest = 0, longestAt = 0;
  for (std::size_t k = 1; k < whole.report.history.size(); ++k) {
    const int products =
        whole.report.history[k].hessianMultiplications - whole.report.history[k - 1].hessianMultiplications;
    if (products > longest) {
      longest = products;
      longestAt = static_cast<int>(k);
    }
  }
  ASSERT_GT(longest, 8) << "no prediction was made";
  observer = {};
  observer.stopAt = longestAt; // in the step that was the longest

  const QpAnswer half = solveQp(program, call);

  ASSERT_EQ(half.report.status, Status::interrupted);
  const int before = whole.report.history[static_cast<std::size_t>(longestAt) - 1].hessianMultiplications;
  EXPECT_LT(half.report.counts.hessianMultiplications - before, longest);
}

TEST(CgInterruptionTest, OneRankStopsAllAtTheSameStep) {
  std::mt19937 random(3);
  const Eigen::MatrixXd a = randomSpd(40, 1e4, random);
  const auto map = linearMap(40);
  LastRankOnly observer;
  observer.stopAt = 6;
  observer.lookAt = 6;
  const RCP<Vector> x = rcp(new Vector(map)), b = makeVector(map, [](int i) { return 1.0 + i; });

  const auto report = qp::solveUnconstrained(rcp(new DenseOperator(map, a)), b, x, 1e-12, 1000, &observer);

  EXPECT_EQ(report.status, Status::interrupted);
  EXPECT_EQ(report.counts.conjugateGradient, 5) << "the first step told of is the start";
  expectSameOnAllRanks(observer.steps);
  EXPECT_EQ(observer.seen, gather(*x));

  observer = {};
  const auto rest = qp::solveUnconstrained(rcp(new DenseOperator(map, a)), b, x, 1e-10, 1000, &observer);
  EXPECT_EQ(rest.status, Status::converged);
  EXPECT_LE((a * gather(*x) - gather(*b)).norm(), 1e-10 * gather(*b).norm());
}

} // namespace
