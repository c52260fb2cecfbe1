#include "QpProblems.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <tuple>

/// Units change nothing: with the objective, the variables or the rows in other units the iteration makes the
/// same steps to the same answer. Powers of two change no digit, so the answer is the same to the last one.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

struct Units {
  double objective = 1, length = 1, rows = 1; ///< f → s f, x → t x, (B, c) → r (B, c)
};

DenseProgram inUnits(DenseProgram program, const Units& units) {
  program.hessian *= units.objective / (units.length * units.length);
  program.linear *= units.objective / units.length;
  program.lower *= units.length;
  program.upper *= units.length;
  program.rows *= units.rows;
  program.values *= units.rows * units.length;
  return program;
}

bool isExact(double factor) {
  int exponent = 0;
  return std::frexp(factor, &exponent) == 0.5;
}

enum class Kind { bounds, rows, scaledRows, redundantRows };

class QpInvarianceTest : public testing::TestWithParam<std::tuple<Kind, double>> {
protected:
  static DenseProgram program() {
    const Kind kind = std::get<0>(GetParam());
    DenseProgram result =
        kind == Kind::bounds ? mixedProgram(24, 50, 89) : mixedProgramWithRows(24, 3, 50, 89);
    if (kind == Kind::redundantRows) {
      result.rows.row(2) = 0.5 * result.rows.row(0);
      result.values[2] = 0.5 * result.values[0];
    }
    return result;
  }
  static double factor() { return std::get<1>(GetParam()); }
  static QpCall call() {
    QpCall result{withTolerance(1e-8)};
    if (std::get<0>(GetParam()) == Kind::scaledRows)
      result.parameters.set("Maximum Dense Rows", 0);
    return result;
  }

  /// The same steps, and the same answer in other units.
  static void expectTheSame(const Units& units) {
    const QpAnswer plain = solveQp(program(), call());

    const QpAnswer scaled = solveQp(inUnits(program(), units), call());

    ASSERT_EQ(plain.report.status, Status::converged);
    EXPECT_EQ(scaled.report.status, Status::converged) << scaled.report.reason;
    const bool exact = isExact(units.objective) && isExact(units.length) && isExact(units.rows);
    const int slack = exact ? 0 : 2;
    EXPECT_NEAR(scaled.report.counts.hessianMultiplications, plain.report.counts.hessianMultiplications,
                slack);
    EXPECT_NEAR(scaled.report.counts.outer, plain.report.counts.outer, slack);
    EXPECT_NEAR(scaled.report.counts.expansion, plain.report.counts.expansion, slack);
    EXPECT_NEAR(scaled.report.counts.proportioning, plain.report.counts.proportioning, slack);
    const double digits = exact ? 0 : 1e-6, force = units.objective / units.length;
    EXPECT_LE((scaled.x / units.length - plain.x).norm(), digits * plain.x.norm());
    EXPECT_LE((scaled.boundMultiplier / force - plain.boundMultiplier).norm(),
              digits * plain.boundMultiplier.norm());
    EXPECT_LE((units.rows * scaled.equalityMultiplier / force - plain.equalityMultiplier).norm(),
              digits * plain.equalityMultiplier.norm());
    EXPECT_NEAR(scaled.report.objective / units.objective, plain.report.objective,
                digits * std::abs(plain.report.objective));
    EXPECT_NEAR(scaled.report.relativeProjectedGradient, plain.report.relativeProjectedGradient,
                exact ? 0 : 1e-8);
  }
};

TEST_P(QpInvarianceTest, OfTheObjective) {
  expectTheSame({.objective = factor()});
}

TEST_P(QpInvarianceTest, OfTheVariables) {
  expectTheSame({.length = factor()});
}

TEST_P(QpInvarianceTest, OfTheRows) {
  if (std::get<0>(GetParam()) != Kind::bounds)
    expectTheSame({.rows = factor()});
}

TEST_P(QpInvarianceTest, OfAllUnitsTogether) {
  expectTheSame({.objective = factor(), .length = 1 / factor(), .rows = factor()});
  expectTheSame({.objective = 1 / factor(), .length = factor(), .rows = factor()});
}

std::string nameOf(const testing::TestParamInfo<std::tuple<Kind, double>>& instance) {
  static constexpr const char* kinds[] = {"bounds", "rows", "scaledRows", "redundantRows"};
  static constexpr const char* factors[] = {"e12", "em12", "two40", "twom40", "two3"};
  return std::string(kinds[static_cast<int>(std::get<0>(instance.param))]) + "_" +
         factors[instance.index % 5];
}

INSTANTIATE_TEST_SUITE_P(Units, QpInvarianceTest,
                         testing::Combine(testing::Values(Kind::bounds, Kind::rows, Kind::scaledRows,
                                                          Kind::redundantRows),
                                          testing::Values(1e12, 1e-12, 0x1p40, 0x1p-40, 8.0)),
                         nameOf);

TEST(QpInvarianceTest, RowsMayHaveUnitsOfTheirOwn) {
  const DenseProgram program = mixedProgramWithRows(24, 3, 50, 97);
  const QpAnswer plain = solveQp(program, {withTolerance(1e-8)});
  for (const bool exact : {true, false}) {
    const Eigen::Vector3d factors =
        exact ? Eigen::Vector3d(0x1p30, 1, 0x1p-30) : Eigen::Vector3d(1e9, 1, 1e-9);
    DenseProgram scaled = program;
    scaled.rows = factors.asDiagonal() * program.rows;
    scaled.values = factors.asDiagonal() * program.values;

    const QpAnswer answer = solveQp(scaled, {withTolerance(1e-8)});

    EXPECT_EQ(answer.report.status, Status::converged);
    EXPECT_NEAR(answer.report.counts.hessianMultiplications, plain.report.counts.hessianMultiplications,
                exact ? 0 : 2);
    EXPECT_LE((answer.x - plain.x).norm(), (exact ? 0 : 1e-6) * plain.x.norm());
    EXPECT_LE((factors.asDiagonal() * answer.equalityMultiplier - plain.equalityMultiplier).norm(),
              (exact ? 0 : 1e-6) * plain.equalityMultiplier.norm());
  }
}

/// Steel in metres and newtons, in millimetres and megapascals, in nanometres: a spring of 2e11 and a gap of
/// 1e-6.
TEST(QpInvarianceTest, TheSystemOfUnitsOfAContactProblemDoesNotMatter) {
  const DenseProgram program = mixedProgramWithRows(30, 2, 100, 101);
  const QpAnswer plain = solveQp(program, {withTolerance(1e-8)});
  for (const Units& units :
       {Units{.objective = 0.2, .length = 1e-6}, Units{.objective = 2e2, .length = 1e-3, .rows = 1e3},
        Units{.objective = 2e-7, .length = 1e3, .rows = 1e-9}}) {
    const QpAnswer answer = solveQp(inUnits(program, units), {withTolerance(1e-8)});

    EXPECT_EQ(answer.report.status, Status::converged);
    EXPECT_NEAR(answer.report.counts.hessianMultiplications, plain.report.counts.hessianMultiplications, 2);
    EXPECT_LE((answer.x / units.length - plain.x).norm(), 1e-6 * plain.x.norm());
  }
}

/// All sums are the same to the last digit on any number of ranks; so are the steps.
TEST(QpInvarianceTest, TheNumberOfRanksDoesNotMatter) {
  for (const int dense : {300, 0})
    for (const int numRows : {0, 3}) {
      const DenseProgram program =
          numRows > 0 ? mixedProgramWithRows(24, numRows, 50, 103) : mixedProgram(24, 50, 103);
      QpCall together{withTolerance(1e-8)};
      together.parameters.set("Maximum Dense Rows", dense);
      QpCall alone = together;
      alone.comm = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));

      const QpAnswer many = solveQp(program, together), one = solveQp(program, alone);

      EXPECT_EQ(many.report.status, one.report.status);
      EXPECT_EQ(many.x, one.x);
      EXPECT_EQ(many.equalityMultiplier, one.equalityMultiplier);
      ASSERT_EQ(many.report.history.size(), one.report.history.size());
      for (std::size_t k = 0; k < one.report.history.size(); ++k)
        EXPECT_EQ(many.report.history[k].objective, one.report.history[k].objective) << "record " << k;
    }
}

} // namespace
