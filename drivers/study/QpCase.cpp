#include "QpCase.hpp"

#include "CaseTable.hpp"
#include "Multigrid.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/benchmarks/PublishedProblems.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::drivers {
namespace {

using benchmarks::BoundBenchmark;

constexpr double tolerance = 1e-6;
constexpr int coarsestSize = 25;

BoundBenchmark makeBenchmark(const std::string& problem, int size, const RCP<const Comm>& comm) {
  if (problem == "journal_bearing")
    return benchmarks::journalBearing(size, comm);
  if (problem == "obstacle")
    return benchmarks::obstacle(size, comm);
  if (problem == "torsion")
    return benchmarks::torsion(size, comm);
  throw InputError("unknown benchmark '" + problem + "'; known are journal_bearing, obstacle and torsion");
}

Teuchos::ParameterList parametersOf(const QpCase& row, double operatorNorm) {
  Teuchos::ParameterList list;
  list.set("Tolerance", tolerance);
  list.set("Operator Norm", operatorNorm);
  Teuchos::ParameterList& mprgp = list.sublist("MPRGP");
  mprgp.set("Expansion", row.expansion);
  mprgp.set("Proportioning Constant", row.proportioningConstant);
  mprgp.set("Expansion Step", row.expansionStep);
  return list;
}

/// A solution with what it has cost.
struct Solved {
  RCP<Vector> x;
  QpResult result;
};

/// x becomes the solution without bounds, by conjugate gradients with multigrid.
void startUnconstrained(const BoundBenchmark& benchmark, const QpCase& row, double operatorNorm, Vector& x,
                        QpResult& result) {
  qp::QuadraticProgram free = benchmark.program();
  free.set = Teuchos::null;
  free.preconditioner = makeMultigrid(benchmark.hessian);
  const qp::QpSolution solution = qp::QpSolver(parametersOf(row, operatorNorm)).solve(free, x);
  result.startMultiplications += solution.report.counts.hessianMultiplications;
}

Solved solveOn(const QpCase& row, const RCP<const Comm>& comm);

/// x becomes the solution on the next coarser mesh, interpolated.
void startNested(const BoundBenchmark& benchmark, const QpCase& row, Vector& x, QpResult& result) {
  const RCP<const Map> map = x.getMap();
  QpCase coarseRow = row;
  coarseRow.size = (row.size - 1) / 2;
  if (coarseRow.size <= coarsestSize) {
    coarseRow.start = "zero";
    coarseRow.preconditioner = "none";
  }
  const Solved coarse = solveOn(coarseRow, map->getComm());
  const benchmarks::Grid coarseGrid = makeBenchmark(row.problem, coarseRow.size, map->getComm()).grid;
  benchmarks::bilinearInterpolation(coarseGrid, coarse.x->getMap(), benchmark.grid, map)->apply(*coarse.x, x);
  const double share = static_cast<double>(coarseGrid.size()) / static_cast<double>(benchmark.grid.size());
  result.startMultiplications +=
      share * (coarse.result.startMultiplications + coarse.result.normMultiplications +
               coarse.result.report.counts.hessianMultiplications);
}

void precondition(const BoundBenchmark& benchmark, const std::string& preconditioner,
                  qp::QuadraticProgram& problem) {
  if (preconditioner == "multigrid")
    problem.preconditioner = makeMultigrid(benchmark.hessian);
  else if (preconditioner == "face_multigrid")
    problem.facePreconditioner = [matrix = benchmark.hessian](const Vector& freeIndicator) {
      return makeFaceMultigrid(matrix, freeIndicator);
    };
}

Solved solveOn(const QpCase& row, const RCP<const Comm>& comm) {
  const BoundBenchmark benchmark = makeBenchmark(row.problem, row.size, comm);
  const RCP<Vector> x = rcp(new Vector(benchmark.hessian->getDomainMap()));
  QpResult result;
  const double begin = Teuchos::Time::wallTime();
  const qp::NormEstimate norm = qp::estimateNorm(*benchmark.hessian, {});
  result.normMultiplications = norm.multiplications;

  const double beforeStart = Teuchos::Time::wallTime();
  if (row.start == "unconstrained")
    startUnconstrained(benchmark, row, norm.norm, *x, result);
  else if (row.start == "nested")
    startNested(benchmark, row, *x, result);
  result.startSeconds = Teuchos::Time::wallTime() - beforeStart;

  qp::QuadraticProgram problem = benchmark.program();
  precondition(benchmark, row.preconditioner, problem);
  result.report = qp::QpSolver(parametersOf(row, norm.norm)).solve(problem, *x).report;
  result.seconds = Teuchos::Time::wallTime() - begin;
  return {x, result};
}

} // namespace

std::vector<QpCase> qpCases(bool quick) {
  std::vector<QpCase> rows;
  for (Case& one : expandCases(caseText("qp"), "qp", quick)) {
    QpCase row{one.name, static_cast<int>(one.value)};
    row.expansion = one.list.get("Expansion", row.expansion);
    row.preconditioner = one.list.get("Preconditioner", row.preconditioner);
    row.start = one.list.get("Start", row.start);
    row.proportioningConstant = one.list.get("Proportioning Constant", row.proportioningConstant);
    row.expansionStep = one.list.get("Expansion Step", row.expansionStep);
    rows.push_back(row);
  }
  return rows;
}

QpResult solveCase(const QpCase& row, const RCP<const Comm>& comm) {
  return solveOn(row, comm).result;
}

std::string methodName(const QpCase& row) {
  std::string name = row.expansion == "projected CG" ? "projected_cg" : row.expansion;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

} // namespace epafi::drivers
