#include "QpProblems.hpp"
#include "RandomPrograms.hpp"
#include "support/DenseOracle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

/// QpSolver against the dense oracle, 1600 programs that have a solution. Every program comes from its seed
/// alone.
///
/// What may differ. An answer x with Bx = c + e and ‖g^P(x)‖ = ‖r‖ is the exact solution for b + r and c + e,
/// so that with the oracle's x* and any multipliers of either
///   d = x − x*:   ‖d‖_A² ≤ ‖r‖‖d‖ + ‖μ − μ*‖‖e‖,   |f(x) − f(x*)| ≤ ‖r‖‖d‖ + (‖μ‖ + ‖μ*‖)‖e‖,
/// and, A being definite with the smallest eigenvalue λ,   λ‖d‖ ≤ ‖r‖ + √(λ‖μ − μ*‖‖e‖).
/// For r stands what was asked for, tolerance · ‖b‖ and the round-off of a product; for e what Bx − c is.
namespace {

using namespace epafi;
using namespace epafi::test;

constexpr unsigned numPrograms = 1600;

/// On several ranks every twentieth program is enough: the sums do not depend on the number of ranks.
unsigned stride() {
  return Tpetra::getDefaultComm()->getSize() == 1 ? 1 : 20;
}

/// What is asked for: 1e-9, or what double precision allows. The number of products grows with the condition
/// number κ, from √κ in a face to κ in an iteration that changes faces without an end, as a degenerate one
/// does; so beyond κ = 1e7 the tolerance grows with κ, from 1e6 on if degenerate.
double attainableTolerance(const RandomProgram& random, const OracleAnswer& oracle) {
  const DenseProgram& program = random.program;
  const double load = program.linear.norm(), size = program.hessian.norm();
  const double length = static_cast<double>(oracle.x.norm());
  const double reference = load > 0 ? load : size * length;
  const double roundOff = program.roundOff(oracle.x.cast<double>(), oracle.multiplier.cast<double>());
  const double condition = size > 0 ? size / random.smallestEigenvalue : 1;
  const double asked = 1e-9 * std::max(1.0, condition / (random.isDegenerate ? 1e6 : 1e7));
  return reference > 0 ? std::max(asked, 100 * roundOff / reference) : asked;
}

/// Three of four with the default parameters; a start of noise every third time. A penalty that does not grow
/// where the residual falls slowly takes thousands of outer iterations on some programs.
QpCall callFor(unsigned seed, double tolerance, Eigen::Index n, double length) {
  static constexpr std::array<const char*, 3> expansions{"projected CG", "fixed step", "active set"};
  static constexpr std::array<const char*, 3> updates{"both", "balance", "penalty"};
  QpCall call{withTolerance(tolerance)};
  call.parameters.sublist("MPRGP").set("Maximum Multiplications", 100000);
  if (seed % 4 == 3) {
    call.parameters.sublist("MPRGP").set("Expansion", std::string(expansions[seed / 4 % 3]));
    call.parameters.sublist("SMALBE").set("Update", std::string(updates[seed / 32 % 3]));
    call.parameters.sublist("SMALBE").set("Maximum Outer Iterations", seed / 32 % 3 == 0 ? 200 : 50000);
  }
  if (seed % 3 == 2) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    call.start = Eigen::VectorXd::NullaryExpr(n, [&] { return length * normal(random); });
  }
  return call;
}

void expectSolved(unsigned seed) {
  const RandomProgram random = randomSolvableProgram(seed);
  const DenseProgram& program = random.program;
  SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.kind);
  const OracleAnswer oracle =
      random.isSingular ? solveByProximalSteps(program) : solveByDualActiveSet(program);
  const double tolerance = attainableTolerance(random, oracle);

  const QpAnswer answer =
      solveQp(program, callFor(seed, tolerance, program.size(), static_cast<double>(oracle.x.norm())));

  const std::string fault = whyNoSolution(program, answer, tolerance);
  EXPECT_EQ(fault, "");
  if (!fault.empty())
    return;
  const Eigen::VectorXd exact = oracle.x.cast<double>(), dual = oracle.multiplier.cast<double>();
  const double length = (answer.x - exact).norm();
  const double load = program.linear.norm(), size = program.hessian.norm();
  const double reference = load > 0 ? load : size * answer.x.norm();
  const double residual = 1.1 * tolerance * reference +
                          20 * program.roundOff(answer.x, answer.equalityMultiplier) +
                          static_cast<double>(oracle.residual);
  double slip = 0, slipOfEither = 0; // ‖μ − μ*‖‖e‖ and (‖μ‖ + ‖μ*‖)‖e‖, row by row
  for (Eigen::Index i = 0; i < program.numRows(); ++i) {
    const double e = std::abs(program.rows.row(i).dot(answer.x) - program.values[i]) +
                     1e-14 * (program.rows.row(i).norm() * answer.x.norm() + std::abs(program.values[i]));
    slip += e * std::abs(answer.equalityMultiplier[i] - dual[i]);
    slipOfEither += e * (std::abs(answer.equalityMultiplier[i]) + std::abs(dual[i]));
  }
  const Eigen::VectorXd d = answer.x - exact;
  EXPECT_LE(d.dot(program.hessian * d), residual * length + slip) << "‖x − x*‖_A²";
  if (!random.isSingular) {
    EXPECT_LE(random.smallestEigenvalue * length, residual + std::sqrt(random.smallestEigenvalue * slip))
        << "‖x − x*‖";
  }
  const double roundOffOfObjective = 1e-13 * (size * answer.x.squaredNorm() + load * answer.x.norm());
  EXPECT_NEAR(static_cast<double>(program.objective(answer.x.cast<Real>()) - oracle.objective), 0,
              residual * length + slipOfEither + roundOffOfObjective)
      << "objective";
  EXPECT_NEAR(answer.report.objective, static_cast<double>(oracle.objective),
              residual * length + slipOfEither + roundOffOfObjective)
      << "reported objective";
}

class RandomProblemsTest : public testing::TestWithParam<unsigned> {};

TEST_P(RandomProblemsTest, AgreesWithTheOracle) {
  for (unsigned seed = GetParam() * 100; seed < (GetParam() + 1) * 100; seed += stride())
    expectSolved(seed);
}

INSTANTIATE_TEST_SUITE_P(Hundreds, RandomProblemsTest, testing::Range(0U, numPrograms / 100));

} // namespace
