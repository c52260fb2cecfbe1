// Expansions that predict the active set, on a problem like that of a wide contact: forces between a punch
// and an elastic ground, each of which moves the ground everywhere.

#include "QpProblems.hpp"

#include "epafi/direct/DenseSymmetric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using namespace epafi;
using namespace epafi::test;

/// n forces x ≥ 0 on a line. What one does to the ground falls with the logarithm of the distance; the punch
/// is a parabola; a stiff spring stands for its equilibrium.
DenseProgram pressedGround(Eigen::Index n) {
  Eigen::MatrixXd influence(n, n);
  Eigen::VectorXd shape(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      influence(i, j) =
          10 + std::log(2.0 * static_cast<double>(n)) - std::log(0.4 + std::abs(static_cast<double>(i - j)));
    const double s = (static_cast<double>(i) + 0.5) / static_cast<double>(n) - 0.45;
    shape[i] = 10 - 80 * s * s;
  }
  DenseProgram program = DenseProgram::unconstrained(influence, shape);
  program.lower = Eigen::VectorXd::Zero(n);
  return program;
}

/// \param isPreconditioned  by an operator that knows the ground, but not the spring
QpAnswer solveGround(const DenseProgram& program, const std::string& expansion, bool isPreconditioned) {
  QpCall call{withTolerance(1e-8)};
  call.parameters.sublist("MPRGP").set("Expansion", expansion);
  if (isPreconditioned)
    call.change = [&](qp::QuadraticProgram& problem) {
      const Eigen::Index n = program.size();
      const Eigen::MatrixXd ground = program.hessian - Eigen::MatrixXd::Constant(n, n, 9.0);
      problem.preconditioner =
          rcp(new DenseOperator(problem.hessian->getDomainMap(), direct::inverseOfSpd(ground)));
    };
  return solveQp(program, call);
}

TEST(ActiveSetExpansionTest, LeadsToTheSolutionInFewerProducts) {
  for (const bool isPreconditioned : {false, true}) {
    const DenseProgram program = pressedGround(600);
    const QpAnswer plain = solveGround(program, "projected CG", isPreconditioned);
    for (const char* expansion : {"active set", "auto"}) {
      SCOPED_TRACE(expansion + std::string(isPreconditioned ? ", preconditioned" : ""));
      const QpAnswer answer = solveGround(program, expansion, isPreconditioned);
      if (expansion == std::string("auto") && !isPreconditioned) {
        EXPECT_EQ(answer.products, plain.products);
        continue;
      }
      EXPECT_EQ(whyNoSolution(program, answer, 1e-8), "");
      EXPECT_LE((answer.x - plain.x).norm(), 1e-5 * plain.x.norm());
      EXPECT_LT(answer.products, 0.75 * plain.products);
    }
  }
}

TEST(ActiveSetExpansionTest, ItsIterationEndsWhereItIsToldTo) {
  const DenseProgram program = pressedGround(200);
  for (const int most : {5, 20, 40}) {
    QpCall call{withTolerance(1e-12)};
    call.parameters.sublist("MPRGP").set("Expansion", std::string("active set"));
    call.parameters.sublist("MPRGP").set("Maximum Multiplications", most);
    const QpAnswer answer = solveQp(program, call);
    EXPECT_EQ(answer.report.status, qp::Status::maxIterations);
    EXPECT_LE(answer.report.counts.hessianMultiplications, most + 3);
    EXPECT_GE(answer.x.minCoeff(), 0.0);
    EXPECT_TRUE(answer.x.allFinite());
  }
}

/// With a preconditioner that knows little of the problem a face takes many steps, and predictions go in
/// circles.
TEST(ActiveSetExpansionTest, CostsLittleWherePredictionsFail) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const DenseProgram program = mixedProgram(60, 40, 700 + seed);
    QpCall call{withTolerance(1e-9)};
    call.parameters.sublist("MPRGP").set("Expansion", std::string("projected CG"));
    const int plain = solveQp(program, call).products;
    call.parameters.sublist("MPRGP").set("Expansion", std::string("active set"));
    const QpAnswer answer = solveQp(program, call);
    EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
    EXPECT_LE(answer.products, 3 * plain + 100);
  }
}

/// As long as projected CG does well nothing is predicted, and without a preconditioner at no time.
TEST(ActiveSetExpansionTest, AutoIsProjectedCgWhereThatDoesWell) {
  int same = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const DenseProgram program = mixedProgram(40, 10, 300 + seed);
    QpCall call{withTolerance(1e-9)};
    call.change = [&](qp::QuadraticProgram& problem) {
      problem.preconditioner =
          rcp(new DenseOperator(problem.hessian->getDomainMap(),
                                direct::inverseOfSpd(program.hessian) + Eigen::MatrixXd::Identity(40, 40)));
    };
    call.parameters.sublist("MPRGP").set("Expansion", std::string("projected CG"));
    const QpAnswer plain = solveQp(program, call);
    call.parameters.sublist("MPRGP").set("Expansion", std::string("auto"));
    const QpAnswer automatic = solveQp(program, call);
    if (plain.report.counts.safeguards == 0) {
      EXPECT_EQ(automatic.products, plain.products) << seed;
      EXPECT_EQ(automatic.x, plain.x) << seed;
      ++same;
    }
  }
  EXPECT_GT(same, 5);
}

} // namespace
