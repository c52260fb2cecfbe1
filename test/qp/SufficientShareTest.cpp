#include "BoundProblems.hpp"

#include "support/Refusal.hpp"

#include "epafi/qp/solve/QpSolver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

/// A CG step that is cut by a bound and of which enough fits ends there, without the product of an expansion.
namespace {

using namespace epafi;
using qp::Status;
using qp::StepKind;
using test::Answer;
using test::infinity;
using test::Problem;
using test::projectedGradient;
using test::randomProblem;

constexpr double shares[] = {0.01, 0.25, 1.0};

Answer solveWithShare(const Problem& problem, double share, double tolerance = 1e-10) {
  const auto map = problem.map();
  const auto a = rcp(new test::DenseOperator(map, problem.a));
  const RCP<const qp::ConvexSet> box =
      rcp(new qp::Box(test::makeVector(map, problem.lower), test::makeVector(map, problem.upper)));
  const auto b = test::makeVector(map, problem.b), x = rcp(new Vector(map));
  qp::MprgpParameters parameters;
  parameters.sufficientShare = share;
  const auto report = qp::solveByMprgp({.hessian = a, .linearTerm = b, .set = box, .operatorNorm = 1.0}, *x,
                                       {tolerance, accurateNorm(*b)}, parameters, nullptr);
  return {test::gather(*x), report, a->applications};
}

/// min ½x² − x over x ≤ bound: the CG step from 0 goes to 1, of which the share `bound` fits.
Problem cutAt(double bound) {
  return {Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Ones(1), Eigen::VectorXd::Constant(1, -infinity),
          Eigen::VectorXd::Constant(1, bound)};
}

/// Products that the steps of a kind took, each.
std::vector<int> productsOf(const qp::History& history, StepKind kind) {
  std::vector<int> products;
  for (std::size_t k = 1; k < history.size(); ++k)
    if (history[k].kind == kind)
      products.push_back(history[k].hessianMultiplications - history[k - 1].hessianMultiplications);
  return products;
}

TEST(SufficientShareTest, ACutStepOfWhichEnoughFitsTakesOneProduct) {
  const auto productsAt = [](double bound, double share) {
    const Answer answer = solveWithShare(cutAt(bound), share);
    EXPECT_EQ(answer.report.status, Status::converged);
    EXPECT_EQ(answer.x[0], bound);
    const std::vector<int> products = productsOf(answer.report.history, StepKind::expansion);
    EXPECT_EQ(products.size(), 1U);
    return products.at(0);
  };
  EXPECT_EQ(productsAt(0.3, 0.25), 1);
  EXPECT_EQ(productsAt(0.25, 0.25), 1); // as much as is asked for
  EXPECT_EQ(productsAt(0.2, 0.25), 2);
  EXPECT_EQ(productsAt(0.02, 0.01), 1);
  EXPECT_EQ(productsAt(0.005, 0.01), 2);
  EXPECT_EQ(productsAt(0.99, 1.0), 2); // 1: never
}

TEST(SufficientShareTest, EveryValueLeadsToTheSameSolution) {
  std::mt19937 random(41);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Problem problem = randomProblem(3 + 2 * repeat, std::pow(10.0, repeat % 5), random);
    const Answer usual = solveWithShare(problem, 0.25);
    for (const double share : shares) {
      SCOPED_TRACE(testing::Message() << repeat << ", share " << share);
      const Answer answer = solveWithShare(problem, share);
      EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
      EXPECT_LE(projectedGradient(problem, answer.x), 1.001e-10 * problem.b.norm() + 1e-14);
      EXPECT_LE((answer.x - usual.x).norm(), 1e-5 * usual.x.norm()); // κ ≤ 10⁴ times the tolerance, and some
      EXPECT_NEAR(answer.report.objective, usual.report.objective,
                  1e-9 * (1 + std::abs(usual.report.objective)));
    }
  }
}

TEST(SufficientShareTest, TheObjectiveNeverGrows) {
  std::mt19937 random(43);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Problem problem = randomProblem(30, std::pow(10.0, repeat % 5), random);
    for (const double share : shares) {
      const Answer answer = solveWithShare(problem, share);
      const auto& history = answer.report.history;
      double size = 1;
      for (const auto& record : history)
        size = std::max(size, std::abs(record.objective));
      for (std::size_t k = 1; k < history.size(); ++k)
        EXPECT_LE(history[k].objective, history[k - 1].objective + 1e-13 * size)
            << repeat << ", share " << share << ", step " << k;
    }
  }
}

/// Expansions by products: one where the step is cut, two where it is followed by a trial, more where that is
/// repeated.
TEST(SufficientShareTest, ItIsAskedForLessOftenTheMoreItAsks) {
  std::mt19937 random(47);
  double average[3] = {0, 0, 0};
  int withOne[3] = {0, 0, 0};
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Problem problem = randomProblem(40, 100, random);
    for (std::size_t s = 0; s < 3; ++s) {
      const std::vector<int> products =
          productsOf(solveWithShare(problem, shares[s]).report.history, StepKind::expansion);
      ASSERT_FALSE(products.empty());
      double sum = 0;
      for (const int number : products) {
        EXPECT_GE(number, 1);
        withOne[s] += number == 1 ? 1 : 0;
        sum += number;
      }
      average[s] += sum / static_cast<double>(products.size());
    }
  }
  EXPECT_LT(average[0], average[1]);
  EXPECT_LT(average[1], average[2]);
  EXPECT_GT(withOne[0], 0);
  EXPECT_GT(withOne[1], 0);
  EXPECT_EQ(withOne[2], 0);
}

TEST(SufficientShareTest, TheSetIsNeverLeft) {
  std::mt19937 random(53);
  for (const double share : shares) {
    const Problem problem = randomProblem(35, 1e3, random);
    const Answer answer = solveWithShare(problem, share);
    EXPECT_TRUE((answer.x.array() >= problem.lower.array()).all());
    EXPECT_TRUE((answer.x.array() <= problem.upper.array()).all());
  }
}

TEST(SufficientShareTest, ValuesOutsideZeroToOneAreRefused) {
  for (const double share : {-0.25, 1.5, std::nan("")}) {
    Teuchos::ParameterList list;
    list.sublist("MPRGP").set("Sufficient Share", share);
    test::expectSays(test::refusal([&] { qp::QpSolver{list}; }), {"Sufficient Share"});
  }
  for (const double share : shares) {
    Teuchos::ParameterList list = qp::MprgpParameters::validParameters();
    EXPECT_EQ(qp::MprgpParameters::from(list.set("Sufficient Share", share)).sufficientShare, share);
  }
  EXPECT_EQ(qp::MprgpParameters::from(qp::MprgpParameters::validParameters()).sufficientShare,
            qp::MprgpParameters().sufficientShare);
}

} // namespace
