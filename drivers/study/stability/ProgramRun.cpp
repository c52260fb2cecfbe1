#include "ProgramRun.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/solve/QpSolver.hpp"

#include <Teuchos_ArrayRCP.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

using benchmarks::DenseProgram;
using Teuchos::ParameterList;

constexpr double tolerance = 1e-8;

/// What the solver returned, on every rank.
struct Answer {
  CaseResult result;
  Eigen::VectorXd x, boundMultiplier, equalityMultiplier;
};

RCP<const Map> linearMap(Eigen::Index n, const RCP<const Comm>& comm) {
  return rcp(new Map(static_cast<Tpetra::global_size_t>(n), 0, comm));
}

RCP<Vector> spread(const RCP<const Map>& map, const Eigen::VectorXd& values) {
  const RCP<Vector> x = rcp(new Vector(map));
  const auto mine = x->getDataNonConst();
  for (Teuchos_Ordinal i = 0; i < mine.size(); ++i)
    mine[i] = values[map->getGlobalElement(static_cast<LocalOrdinal>(i))];
  return x;
}

/// The whole vector on every rank; empty for null. Collective.
Eigen::VectorXd gathered(const RCP<const Vector>& x) {
  if (x.is_null())
    return {};
  const Eigen::Index n = x->getGlobalLength();
  Eigen::VectorXd mine = Eigen::VectorXd::Zero(n), all = mine;
  const auto values = x->getData();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    mine[x->getMap()->getGlobalElement(static_cast<LocalOrdinal>(i))] = values[i];
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
std::string complaint(const DenseProgram& program, const Answer& answer) {
  std::ostringstream text;
  if (!answer.x.allFinite() || !answer.boundMultiplier.allFinite() || !answer.equalityMultiplier.allFinite())
    return "x or a multiplier is not finite";
  const auto found = benchmarks::residuals(program, answer.x.cast<benchmarks::Real>(),
                                           answer.equalityMultiplier.cast<benchmarks::Real>());
  const double load = program.linear.norm();
  const double reference = load > 0 ? load : program.hessian.norm() * answer.x.norm();
  if (found.feasibility > 0)
    text << "a bound is violated by " << found.feasibility << "; ";
  if (!(found.projectedGradient() <=
        1.01 * tolerance * reference + 20 * program.roundOff(answer.x, answer.equalityMultiplier)))
    text << "projected gradient " << found.projectedGradient() / reference << "; ";
  if (!(found.relativeEquality <= std::max(10 * tolerance, 1e-12)))
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

/// Replaces the entries that a list names by their numbers.
void replaceEntries(const ParameterList& list, const std::string& name, Eigen::Ref<Eigen::MatrixXd> values) {
  if (!list.isSublist(name))
    return;
  const ParameterList& entries = list.sublist(name);
  for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
    std::istringstream indices(entries.name(entry));
    Eigen::Index i = 0, j = 0;
    indices >> i;
    if (values.cols() > 1)
      indices >> j;
    values(i, j) = Teuchos::getValue<double>(entries.entry(entry));
  }
}

Eigen::VectorXd startOf(const ParameterList& list, const DenseProgram& program) {
  const Eigen::Index n = program.size();
  if (!list.isParameter("Start"))
    return Eigen::VectorXd::Zero(n);
  if (list.isType<double>("Start"))
    return Eigen::VectorXd::Constant(n, list.get<double>("Start"));
  if (list.get<std::string>("Start") == "ascending")
    return Eigen::VectorXd::LinSpaced(n, 1, static_cast<double>(n));
  return program.hessian.ldlt().solve(program.linear);
}

Answer solve(const ParameterList& list, const RCP<const Comm>& comm) {
  const DenseProgram program = programOf(list.sublist("Program"));
  const qp::QuadraticProgram problem = toQuadraticProgram(program, comm);
  ParameterList parameters;
  if (list.isSublist("Solver"))
    parameters = list.sublist("Solver");
  parameters.set("Tolerance", tolerance).set("Constraint Tolerance", tolerance);
  const RCP<const Map> map = problem.hessian->getDomainMap();
  const RCP<Vector> x = spread(map, startOf(list.sublist("Program"), program));
  qp::QpSolver solver(parameters);
  const qp::QpSolution solution = solver.solve(problem, *x);
  const qp::SolveReport& report = solution.report;

  Answer answer;
  answer.x = gathered(x);
  answer.boundMultiplier = gathered(solution.boundMultiplier);
  answer.equalityMultiplier = gathered(solution.equalityMultiplier);
  CaseResult& result = answer.result;
  result.status = qp::toString(report.status);
  result.reason = report.reason;
  result.products = report.counts.hessianMultiplications;
  result.projectedGradient = report.relativeProjectedGradient;
  result.energy = report.objective;
  if (report.status == qp::Status::converged) {
    result.outcome = Outcome::solved;
    if (const std::string wrong = complaint(program, answer); !wrong.empty())
      result.judge("it is claimed to be solved, but: " + wrong);
  } else if (report.status == qp::Status::infeasible || report.status == qp::Status::unbounded) {
    const std::string wrong = doubt(program, report.status, gathered(report.certificate));
    result.outcome = wrong.empty() ? Outcome::noSolution : Outcome::wrongAnswer;
    if (!wrong.empty())
      result.reason = "its certificate does not hold: " + wrong;
  } else {
    result.outcome = report.status == qp::Status::notUnique ? Outcome::notUnique : Outcome::stopped;
  }
  return answer;
}

/// What a second solve with the same data does otherwise, and what the first one did to them.
std::string solveTwice(const DenseProgram& program, const RCP<const Comm>& comm) {
  const qp::QuadraticProgram problem = toQuadraticProgram(program, comm);
  const RCP<const Map> map = problem.hessian->getDomainMap();
  const RCP<Vector> first = rcp(new Vector(map)), second = rcp(new Vector(map)),
                    lowest = rcp(new Vector(map));
  qp::QpSolver solver;
  solver.solve(problem, *first);
  solver.solve(problem, *second);
  lowest->putScalar(-1e6);
  problem.set->project(*lowest);
  return gathered(first) != gathered(second)              ? "the second solve differs"
         : gathered(problem.linearTerm) != program.linear ? "the linear term was changed"
         : gathered(lowest) != program.lower              ? "the lower bound was changed"
                                                          : "";
}

/// Of multipliers that are to be the same, or, if there are other numbers of them, to add up to the same.
bool areAlike(const Eigen::VectorXd& found, const Eigen::VectorXd& reference) {
  constexpr double allowed = 1e-5;
  return found.size() == reference.size()
             ? (found - reference).norm() <= allowed * reference.norm()
             : std::abs(found.sum() - reference.sum()) <= allowed * std::abs(reference.sum());
}

std::string difference(const Answer& found, const Answer& reference, double unit) {
  std::ostringstream text;
  if (!((found.x - reference.x).norm() <= 1e-6 * reference.x.norm()))
    text << "x changes by " << (found.x - reference.x).norm() << "; ";
  if (!areAlike(found.boundMultiplier / unit, reference.boundMultiplier))
    text << "multipliers of bounds are not " << unit << " times as large; ";
  if (!areAlike(found.equalityMultiplier / unit, reference.equalityMultiplier))
    text << "multipliers of rows are not " << unit << " times as large; ";
  return text.str();
}

} // namespace

DenseProgram programOf(const ParameterList& list) {
  const auto number = [&](const char* name, double other) {
    return list.isType<double>(name) ? list.get<double>(name) : other;
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto n = static_cast<Eigen::Index>(number("Size", 0));
  DenseProgram program = DenseProgram::unconstrained(Eigen::MatrixXd::Zero(n, n),
                                                     Eigen::VectorXd::Constant(n, number("Load", 0)));
  for (Eigen::Index i = 0; i < n && number("Springs", 1) > 0; ++i) {
    program.hessian(i, i) = i + 1 < n ? 2 : 1;
    if (i + 1 < n)
      program.hessian(i, i + 1) = program.hessian(i + 1, i) = -1;
  }
  for (Eigen::Index i = 0; i < n && list.isType<std::string>("Load"); ++i) // "wavy"
    program.linear[i] =
        0.05 * std::sin(0.9 * static_cast<double>(i)) - 0.01 * std::cos(0.17 * static_cast<double>(i));
  program.lower.setConstant(number("Lower", -infinity));
  program.upper.setConstant(number("Upper", infinity));
  const auto rows = static_cast<Eigen::Index>(number("Rows", 0));
  program.rows = Eigen::MatrixXd::Ones(rows, n);
  for (Eigen::Index i = 1; i < rows; ++i)
    program.rows(i, i) += number("Change", 0);
  program.values = Eigen::VectorXd::Constant(rows, number("Value", 0));
  replaceEntries(list, "Hessian Entries", program.hessian);
  replaceEntries(list, "Load Entries", program.linear);
  replaceEntries(list, "Lower Entries", program.lower);
  replaceEntries(list, "Upper Entries", program.upper);
  replaceEntries(list, "Value Entries", program.values);
  program.hessian *= number("Factor", 1);
  program.linear *= number("Factor", 1);
  return program;
}

CaseResult runProgram(const ParameterList& list, const RCP<const Comm>& comm) {
  Answer answer = solve(list, comm);
  ParameterList given = list;
  if (given.isSublist("Reference"))
    answer.result.judge(
        difference(answer, solve(list.sublist("Reference"), comm), given.get("Unit of Energy", 1.0)));
  if (given.get("Check", "") == "solve twice")
    answer.result.judge(solveTwice(programOf(list.sublist("Program")), comm));
  return answer.result;
}

} // namespace epafi::drivers
