#include "FaultyOperators.hpp"
#include "QpProblems.hpp"

#include <gtest/gtest.h>

#include <cmath>

/// Operators that return NaN or infinity, at once or later: x stays finite and within the bounds, and nobody
/// calls it a solution.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

bool isWithinBounds(const DenseProgram& program, const Eigen::VectorXd& x) {
  return x.allFinite() && (x.array() >= program.lower.array()).all() &&
         (x.array() <= program.upper.array()).all();
}

/// Solves with an operator that is good for `healthy` products and then writes `value` in entry `row`.
QpAnswer solveFaulty(const DenseProgram& program, int healthy, int row, double value,
                     const Teuchos::ParameterList& parameters) {
  QpCall call{parameters};
  call.change = [&](qp::QuadraticProgram& problem) {
    problem.hessian =
        rcp(new FaultyOperator(problem.hessian->getDomainMap(), program.hessian, healthy, row, value));
  };
  return solveQp(program, call);
}

TEST(QpNotFiniteTest, NanFromTheFirstProductIsNamed) {
  for (const bool hasRows : {false, true}) {
    const DenseProgram program = hasRows ? mixedProgramWithRows(15, 2, 10, 61) : mixedProgram(15, 10, 61);

    const QpAnswer answer = solveFaulty(program, 0, 3, std::nan(""), {});

    EXPECT_EQ(answer.report.status, Status::notFinite);
    EXPECT_TRUE(isWithinBounds(program, answer.x));
  }
}

/// Bounds only or with rows; NaN, infinity.
class QpLateFaultTest : public testing::TestWithParam<std::tuple<bool, double, std::string>> {
protected:
  static DenseProgram program() {
    return std::get<0>(GetParam()) ? mixedProgramWithRows(20, 2, 100, 67) : mixedProgram(20, 100, 67);
  }
  static Teuchos::ParameterList parameters() {
    Teuchos::ParameterList result = withTolerance(1e-10);
    result.set("Operator Norm", 1.0);
    result.sublist("MPRGP").set("Expansion", std::get<2>(GetParam()));
    return result;
  }
};

TEST_P(QpLateFaultTest, IsNamedWhereverItAppears) {
  const QpAnswer healthy = solveQp(program(), {parameters()});
  ASSERT_EQ(healthy.report.status, Status::converged);
  for (int products = 0; products < std::min(healthy.products, 40); ++products)
    for (const int row : {2, 3}) { // bounded above; free
      SCOPED_TRACE("after " + std::to_string(products) + " products, in entry " + std::to_string(row));

      const QpAnswer answer = solveFaulty(program(), products, row, std::get<1>(GetParam()), parameters());

      EXPECT_EQ(answer.report.status, Status::notFinite) << answer.report.reason;
      EXPECT_TRUE(isWithinBounds(program(), answer.x));
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, QpLateFaultTest,
                         testing::Combine(testing::Bool(),
                                          testing::Values(std::nan(""), unlimited, -unlimited),
                                          testing::Values("projected CG", "fixed step", "active set")));

TEST(QpNotFiniteTest, NanInAFixedEntryIsNotOverlooked) {
  const DenseProgram program = mixedProgram(10, 10, 71); // entry 4 is fixed
  Teuchos::ParameterList parameters;
  parameters.set("Operator Norm", 1.0);

  const QpAnswer answer = solveFaulty(program, 0, 4, std::nan(""), parameters);

  EXPECT_EQ(answer.report.status, Status::notFinite);
  EXPECT_TRUE(isWithinBounds(program, answer.x));
}

TEST(QpNotFiniteTest, InfinityThatPushesAgainstABoundIsNotOverlooked) {
  DenseProgram program = DenseProgram::unconstrained(Eigen::Matrix3d::Identity(), Eigen::Vector3d(1, -1, 1));
  program.lower = Eigen::Vector3d(0.5, 0.5, 0.5);
  Teuchos::ParameterList parameters;
  parameters.set("Operator Norm", 1.0);

  const QpAnswer answer = solveFaulty(program, 0, 1, unlimited, parameters);

  EXPECT_EQ(answer.report.status, Status::notFinite);
  EXPECT_TRUE(isWithinBounds(program, answer.x));
}

TEST(QpNotFiniteTest, NanFromThePreconditionerIsNamed) {
  for (const bool hasRows : {false, true}) {
    const DenseProgram program = hasRows ? mixedProgramWithRows(15, 2, 100, 73) : mixedProgram(15, 100, 73);
    for (const int healthy : {0, 3}) {
      QpCall call{withTolerance(1e-10)};
      call.change = [&](qp::QuadraticProgram& problem) {
        problem.preconditioner = rcp(new FaultyOperator(problem.hessian->getDomainMap(),
                                                        Eigen::MatrixXd::Identity(15, 15), healthy, 3));
      };

      const QpAnswer answer = solveQp(program, call);

      EXPECT_EQ(answer.report.status, Status::notFinite) << answer.report.reason;
      EXPECT_TRUE(isWithinBounds(program, answer.x));
    }
  }
}

} // namespace
