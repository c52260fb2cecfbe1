#include "QpProblems.hpp"

#include "epafi/qp/constraints/Box.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace epafi::test {

qp::QuadraticProgram toQuadraticProgram(const DenseProgram& program, const RCP<const Comm>& comm) {
  const RCP<const Map> map = linearMap(static_cast<int>(program.size()), comm);
  qp::QuadraticProgram problem;
  problem.hessian = rcp(new DenseOperator(map, program.hessian));
  problem.linearTerm = makeVector(map, program.linear);
  const bool hasLower = (program.lower.array() > -unlimited).any();
  const bool hasUpper = (program.upper.array() < unlimited).any();
  if (hasLower || hasUpper)
    problem.set = rcp(new qp::Box(hasLower ? makeVector(map, program.lower) : RCP<Vector>(),
                                  hasUpper ? makeVector(map, program.upper) : RCP<Vector>()));
  if (program.numRows() > 0) {
    const RCP<const Map> range = linearMap(static_cast<int>(program.numRows()), comm);
    problem.constraintMatrix = rcp(new DenseRows(map, range, program.rows));
    problem.constraintValues = makeVector(range, program.values);
  }
  return problem;
}

QpAnswer solveQp(const DenseProgram& program, const QpCall& call) {
  qp::QuadraticProgram problem = toQuadraticProgram(program, call.comm);
  const auto hessian = Teuchos::rcp_dynamic_cast<const DenseOperator>(problem.hessian);
  if (call.change)
    call.change(problem);
  const RCP<const Map> map = problem.hessian->getDomainMap();
  const RCP<Vector> x = call.start.size() > 0 ? makeVector(map, call.start) : rcp(new Vector(map));
  qp::QpSolver solver(call.parameters);
  const qp::QpSolution solution = solver.solve(problem, *x, call.observer);
  const auto dense = [](const RCP<Vector>& vector) {
    return vector.is_null() ? Eigen::VectorXd() : gather(*vector);
  };
  return {gather(*x),
          dense(solution.boundMultiplier),
          dense(solution.equalityMultiplier),
          dense(solution.report.certificate),
          solution.report,
          hessian->applications};
}

Teuchos::ParameterList withTolerance(double tolerance) {
  Teuchos::ParameterList parameters;
  parameters.set("Tolerance", tolerance);
  parameters.set("Constraint Tolerance", std::max(tolerance, 1e-15));
  return parameters;
}

std::string whyNoSolution(const DenseProgram& program, const QpAnswer& answer, double tolerance) {
  std::ostringstream text;
  const qp::SolveReport& report = answer.report;
  if (report.status != qp::Status::converged)
    text << toString(report.status) << ": " << report.reason << "; ";
  if (answer.x.size() != program.size() || !answer.x.allFinite() ||
      answer.boundMultiplier.size() != program.size() ||
      answer.equalityMultiplier.size() != program.numRows() || !answer.boundMultiplier.allFinite() ||
      !answer.equalityMultiplier.allFinite()) {
    text << "x or the multipliers are missing or not finite; ";
    return text.str();
  }
  const DenseResiduals found =
      residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>());
  const double roundOff = 20 * program.roundOff(answer.x, answer.equalityMultiplier);
  const bool hasLoad = program.linear.norm() > 0;
  const double reference = hasLoad ? program.linear.norm() : program.hessian.norm() * answer.x.norm();
  if (found.feasibility > 0)
    text << "a bound is violated by " << found.feasibility << "; ";
  if (found.projectedGradient() > 1.00001 * tolerance * reference + roundOff)
    text << "‖gᴾ‖ = " << found.projectedGradient() << " against " << reference << "; ";
  if (found.relativeEquality > std::max(10 * tolerance, 1e-12))
    text << "|Bx − c| = " << found.relativeEquality << " relative; ";
  if (hasLoad && (std::abs(report.kkt.stationarity * reference - found.stationarity) >
                      roundOff + 1e-6 * found.stationarity ||
                  std::abs(report.kkt.dualFeasibility * reference - found.dualFeasibility) >
                      roundOff + 1e-6 * found.dualFeasibility))
    text << "reported ‖φ‖, ‖β‖ " << report.kkt.stationarity << ", " << report.kkt.dualFeasibility
         << ", recomputed " << found.stationarity / reference << ", " << found.dualFeasibility / reference
         << "; ";
  const Eigen::VectorXd gradient =
      program.gradient(answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>()).cast<double>();
  for (Eigen::Index i = 0; i < answer.x.size(); ++i) {
    const bool isFree = program.lower[i] < answer.x[i] && answer.x[i] < program.upper[i];
    const double expected = isFree ? 0.0 : gradient[i];
    if (std::abs(answer.boundMultiplier[i] - expected) > roundOff + 1e-9 * std::abs(expected))
      text << "multiplier of the bound of entry " << i << " is " << answer.boundMultiplier[i] << ", not "
           << expected << "; ";
  }
  return text.str();
}

DenseProgram mixedProgram(int n, double condition, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  DenseProgram program = DenseProgram::unconstrained(randomSpd(n, condition, random), Eigen::VectorXd(n));
  for (int i = 0; i < n; ++i) {
    program.linear[i] = normal(random);
    const double centre = normal(random);
    const int kind = i % 5;
    if (kind == 0 || kind == 1)
      program.lower[i] = centre - 0.5;
    if (kind == 0 || kind == 2)
      program.upper[i] = centre + 0.5;
    if (kind == 4)
      program.lower[i] = program.upper[i] = centre;
  }
  return program;
}

DenseProgram mixedProgramWithRows(int n, int m, double condition, unsigned seed) {
  DenseProgram program = mixedProgram(n, condition, seed);
  std::mt19937 random(seed + 1);
  std::normal_distribution<double> normal;
  program.rows = Eigen::MatrixXd(m, n);
  for (Eigen::Index i = 0; i < program.rows.size(); ++i)
    program.rows.data()[i] = normal(random);
  Eigen::VectorXd inside(n);
  for (int i = 0; i < n; ++i)
    inside[i] = std::clamp(normal(random), program.lower[i], program.upper[i]);
  program.values = program.rows * inside;
  return program;
}

} // namespace epafi::test
