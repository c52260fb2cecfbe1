#include "support/DenseOracle.hpp"
#include "RandomPrograms.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace epafi::test;

TEST(DenseOracleTest, SolvesTwoUnknownsByHand) {
  // min x² + y² − 2x + 2y over x, y ≥ 0: x = 1, y = 0 with force 2.
  DenseProgram program = DenseProgram::unconstrained(2 * Eigen::Matrix2d::Identity(), Eigen::Vector2d(2, -2));
  program.lower.setZero();

  const OracleAnswer answer = solveByDualActiveSet(program);

  EXPECT_EQ(static_cast<double>(answer.x[0]), 1);
  EXPECT_EQ(static_cast<double>(answer.x[1]), 0);
  EXPECT_EQ(static_cast<double>(answer.objective), -1);
}

/// A multiple of the round-off of ‖A‖‖x‖ + ‖b‖ in extended precision.
double allowance(const DenseProgram& program, const OracleAnswer& answer) {
  return 1e-15 * (program.hessian.norm() * static_cast<double>(answer.x.norm()) + program.linear.norm());
}

TEST(DenseOracleTest, AgreesWithEveryActiveSetTried) {
  int tried = 0;
  for (unsigned seed = 0; tried < 150; ++seed) {
    const RandomProgram random = randomSolvableProgram(seed);
    const DenseProgram& program = random.program;
    if (program.size() > 6)
      continue;
    ++tried;

    const OracleAnswer answer =
        random.isSingular ? solveByProximalSteps(program) : solveByDualActiveSet(program);
    const OracleAnswer enumerated = solveByEnumeration(program);

    ASSERT_TRUE(answer.isFeasible && enumerated.isFeasible) << "seed " << seed << ": " << random.kind;
    EXPECT_LE(answer.residual, allowance(program, answer)) << "seed " << seed << ": " << random.kind;
    const double size =
        static_cast<double>(std::abs(answer.objective)) +
        program.hessian.norm() * static_cast<double>(answer.x.squaredNorm() + enumerated.x.squaredNorm());
    EXPECT_NEAR(static_cast<double>(answer.objective - enumerated.objective), 0, 1e-11 * size)
        << "seed " << seed << ": " << random.kind;
  }
}

TEST(DenseOracleTest, EndsAtAKktPointWhateverTheCondition) {
  for (unsigned seed = 5000; seed < 5200; ++seed) {
    const RandomProgram random = randomSolvableProgram(seed);
    const DenseProgram& program = random.program;

    const OracleAnswer answer =
        random.isSingular ? solveByProximalSteps(program) : solveByDualActiveSet(program);

    ASSERT_TRUE(answer.isFeasible) << "seed " << seed << ": " << random.kind;
    const DenseResiduals found = residuals(program, answer.x, answer.multiplier);
    EXPECT_LE(found.projectedGradient(), allowance(program, answer))
        << "seed " << seed << ": " << random.kind;
    EXPECT_LE(found.feasibility, 0) << "seed " << seed << ": " << random.kind;
    EXPECT_LE(found.relativeEquality, 1e-14) << "seed " << seed << ": " << random.kind;
  }
}

TEST(DenseOracleTest, ProvesInfeasibility) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const RandomProgram random = randomInfeasibleProgram(seed);

    const OracleAnswer answer = solveByDualActiveSet(random.program);

    EXPECT_FALSE(answer.isFeasible) << "seed " << seed << ": " << random.kind;
    if (answer.certificate.size() > 0) {
      EXPECT_GT(separation(random.program, answer.certificate), 0) << "seed " << seed << ": " << random.kind;
    }
  }
}

} // namespace
