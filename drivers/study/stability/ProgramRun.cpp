#include "ProgramRun.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/qp/Box.hpp"

#include <Teuchos_ArrayRCP.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

using benchmarks::DenseProgram;

RCP<const Map> linearMap(Eigen::Index n, const RCP<const Comm>& comm) {
  return rcp(new Map(static_cast<Tpetra::global_size_t>(n), 0, comm));
}

RCP<Vector> spread(const RCP<const Map>& map, const Eigen::VectorXd& values) {
  const RCP<Vector> x = rcp(new Vector(map));
  const auto mine = x->getDataNonConst();
  for (Teuchos_Ordinal i = 0; i < mine.size(); ++i)
    mine[i] = values[static_cast<Eigen::Index>(map->getGlobalElement(static_cast<LocalOrdinal>(i)))];
  return x;
}

/// The whole vector on every rank; empty for null. Collective.
Eigen::VectorXd gathered(const RCP<const Vector>& x) {
  if (x.is_null())
    return {};
  const auto n = static_cast<Eigen::Index>(x->getGlobalLength());
  Eigen::VectorXd mine = Eigen::VectorXd::Zero(n), all = mine;
  const auto values = x->getData();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    mine[static_cast<Eigen::Index>(x->getMap()->getGlobalElement(static_cast<LocalOrdinal>(i)))] = values[i];
  Teuchos::reduceAll(*x->getMap()->getComm(), Teuchos::REDUCE_SUM, static_cast<int>(n), mine.data(),
                     all.data());
  return all;
}

RCP<CrsMatrix> sparse(const Eigen::MatrixXd& matrix, const RCP<const Map>& rows,
                      const RCP<const Map>& columns) {
  const RCP<CrsMatrix> result = rcp(new CrsMatrix(rows, static_cast<std::size_t>(matrix.cols())));
  for (std::size_t i = 0; i < numLocal(*rows); ++i) {
    const GlobalOrdinal row = rows->getGlobalElement(static_cast<LocalOrdinal>(i));
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      const double value = matrix(static_cast<Eigen::Index>(row), j);
      const GlobalOrdinal column = j;
      if (value != 0)
        result->insertGlobalValues(row, 1, &value, &column);
    }
  }
  result->fillComplete(columns, rows);
  return result;
}

/// What is wrong with an answer that is said to have converged.
std::string complaint(const ProgramTask& task, const ProgramAnswer& answer) {
  std::ostringstream text;
  if (!answer.x.allFinite() || !answer.boundMultiplier.allFinite() || !answer.equalityMultiplier.allFinite())
    return "x or a multiplier is not finite";
  const DenseProgram& program = task.program;
  const auto found = benchmarks::residuals(program, answer.x.cast<benchmarks::Real>(),
                                           answer.equalityMultiplier.cast<benchmarks::Real>());
  const double load = program.linear.norm();
  const double reference = load > 0 ? load : program.hessian.norm() * answer.x.norm();
  if (found.feasibility > 0)
    text << "a bound is violated by " << found.feasibility << "; ";
  if (!(found.projectedGradient() <=
        1.01 * task.tolerance * reference + 20 * program.roundOff(answer.x, answer.equalityMultiplier)))
    text << "projected gradient " << found.projectedGradient() / reference << "; ";
  if (!(found.relativeEquality <= std::max(10 * task.tolerance, 1e-12)))
    text << "rows are violated by " << found.relativeEquality << "; ";
  return text.str();
}

/// Why the certificate proves nothing; empty if it does, or if the box itself is empty.
std::string doubt(const DenseProgram& program, qp::Status status, const Eigen::VectorXd& certificate) {
  if (status == qp::Status::unbounded)
    return benchmarks::whyNotRecession(program, certificate);
  if ((program.lower.array() > program.upper.array()).any())
    return "";
  if (certificate.size() != program.numRows() || certificate.size() == 0)
    return "no certificate";
  return benchmarks::separation(program, certificate) > 0 ? "" : "the certificate separates nothing";
}

} // namespace

qp::QuadraticProgram toQuadraticProgram(const DenseProgram& program, const RCP<const Comm>& comm) {
  const RCP<const Map> map = linearMap(program.size(), comm);
  qp::QuadraticProgram problem;
  problem.hessian = sparse(program.hessian, map, map);
  problem.linearTerm = spread(map, program.linear);
  problem.set = rcp(new qp::Box(spread(map, program.lower), spread(map, program.upper)));
  if (program.numRows() > 0) {
    const RCP<const Map> rows = linearMap(program.numRows(), comm);
    problem.constraintMatrix = sparse(program.rows, rows, map);
    problem.constraintValues = spread(rows, program.values);
  }
  return problem;
}

ProgramAnswer solveProgram(const ProgramTask& task, const RCP<const Comm>& comm) {
  const qp::QuadraticProgram problem = toQuadraticProgram(task.program, comm);
  Teuchos::ParameterList parameters = task.parameters;
  parameters.set("Tolerance", task.tolerance).set("Constraint Tolerance", task.tolerance);
  const RCP<const Map> map = problem.hessian->getDomainMap();
  const RCP<Vector> x = task.start.size() > 0 ? spread(map, task.start) : rcp(new Vector(map));
  qp::QpSolver solver(parameters);
  const qp::QpSolution solution = solver.solve(problem, *x);
  const qp::SolveReport& report = solution.report;

  ProgramAnswer answer;
  answer.x = gathered(x);
  answer.boundMultiplier = gathered(solution.boundMultiplier);
  answer.equalityMultiplier = gathered(solution.equalityMultiplier);
  CaseResult& result = answer.result;
  result.status = qp::toString(report.status);
  result.reason = report.reason;
  result.products = report.counts.hessianMultiplications;
  result.projectedGradient = report.relativeProjectedGradient;
  result.energy = report.objective;
  if (report.status == qp::Status::converged || report.status == qp::Status::infeasible ||
      report.status == qp::Status::unbounded) {
    const bool isSolved = report.status == qp::Status::converged;
    const std::string wrong =
        isSolved ? complaint(task, answer) : doubt(task.program, report.status, gathered(report.certificate));
    result.outcome = !wrong.empty() ? Outcome::wrongAnswer : isSolved ? Outcome::solved : Outcome::noSolution;
    if (!wrong.empty())
      result.reason =
          (isSolved ? "it is claimed to be solved, but: " : "its certificate does not hold: ") + wrong;
  } else {
    result.outcome = report.status == qp::Status::notUnique ? Outcome::notUnique : Outcome::stopped;
  }
  return answer;
}

} // namespace epafi::drivers
