#include "TablesStudy.hpp"

#include "SceneRun.hpp"

#include "epafi/output/AtomicFile.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <Teuchos_Comm.hpp>

#include <array>
#include <iostream>
#include <sstream>

namespace epafi::drivers {
namespace {

/// A cell of the paper's tables: Dostál, Horák, Stefanica, *An Overview of Scalable FETI-DP Algorithms for
/// Variational Inequalities*, Table 1 (coercive) and Table 2 (semicoercive).
struct Cell {
  bool coercive;
  int subdomainsPerSide; ///< 1/H
  int elementsPerSide;   ///< H/h
  GlobalOrdinal primalDimension, dualDimension, corners;
  int iterations; ///< CG iterations
};

constexpr std::array<Cell, 18> paper{{
    {true, 2, 16, 2312, 153, 10, 33},
    {true, 4, 16, 9248, 785, 42, 39},
    {true, 8, 16, 36992, 3489, 154, 43},
    {true, 2, 8, 648, 73, 10, 20},
    {true, 4, 8, 2592, 369, 42, 32},
    {true, 8, 8, 10368, 1633, 154, 34},
    {true, 2, 4, 200, 33, 10, 19},
    {true, 4, 4, 800, 161, 42, 24},
    {true, 8, 4, 3200, 705, 154, 27},
    {false, 2, 16, 2312, 153, 10, 61},
    {false, 4, 16, 9248, 785, 42, 51},
    {false, 8, 16, 36992, 3489, 154, 53},
    {false, 2, 8, 648, 73, 10, 38},
    {false, 4, 8, 2592, 369, 42, 36},
    {false, 8, 8, 10368, 1633, 154, 46},
    {false, 2, 4, 200, 33, 10, 29},
    {false, 4, 4, 800, 161, 42, 28},
    {false, 8, 4, 3200, 705, 154, 35},
}};

std::string name(const Cell& cell) {
  return cell.coercive ? "coercive" : "semicoercive";
}

/// One row of each table.
struct Rows {
  std::string csv, markdown;
  bool converged;
};

Rows solveCell(const Cell& cell, const RCP<const Comm>& comm) {
  const scene::Scene scene = scene::modelProblem(cell.coercive, cell.subdomainsPerSide,
                                                 cell.subdomainsPerSide * cell.elementsPerSide);
  Teuchos::ParameterList plain; // the paper's method
  plain.sublist("Preconditioner").set("Type", "none");
  const SceneRun run = solveScene(scene, plain, comm);
  const int preconditioned =
      solveScene(scene, Teuchos::ParameterList(), comm).solver->report().counts.hessianMultiplications;
  const auto& problem = run.decomposition->problem;
  const qp::SolveReport& report = run.solver->report();
  const qp::StepCounts& counts = report.counts;
  std::ostringstream csv, markdown;
  csv << name(cell) << ',' << cell.subdomainsPerSide << ',' << cell.elementsPerSide << ','
      << problem.primalDimension << ',' << problem.dualDimension() << ',' << problem.numCrosspoints << ','
      << counts.conjugateGradient << ',' << counts.expansion << ',' << counts.proportioning << ','
      << counts.hessianMultiplications << ',' << counts.outer << ',' << run.solution.relativeProjectedGradient
      << ',' << run.solver->times().setup << ',' << run.solver->times().solve << ',' << cell.iterations << ','
      << run.solver->dualProblem().norm().multiplications << ',' << preconditioned << '\n';
  markdown << "| " << name(cell) << " | " << cell.subdomainsPerSide << " | " << cell.elementsPerSide << " | "
           << problem.primalDimension << " / " << cell.primalDimension << " | " << problem.dualDimension()
           << " / " << cell.dualDimension << " | " << problem.numCrosspoints << " / " << cell.corners << " | "
           << counts.conjugateGradient << " / " << cell.iterations << " | " << counts.expansion << " | "
           << counts.proportioning << " | " << counts.outer << " | " << counts.hessianMultiplications << " | "
           << preconditioned << " |\n";
  return {csv.str(), markdown.str(), report.status == qp::Status::converged};
}

} // namespace

bool studyTables(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  std::string csv =
      "problem,H_inverse,H_over_h,primal_dimension,dual_dimension,corners,cg_iterations,expansion_steps,"
      "proportioning_steps,hessian_multiplications,outer_iterations,relative_projected_gradient,"
      "setup_seconds,solve_seconds,paper_cg_iterations,norm_multiplications,preconditioned_multiplications\n";
  std::string markdown =
      "| problem | 1/H | H/h | primal (ours / paper) | dual (ours / paper) | corners (ours / paper) | CG "
      "steps (ours / paper) | expansions | proportionings | outer | products with F | with Dirichlet "
      "preconditioner "
      "|\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  bool allConverged = true;
  for (const Cell& cell : paper) {
    if (quick && cell.elementsPerSide > 8)
      continue;
    const Rows rows = solveCell(cell, comm);
    csv += rows.csv;
    markdown += rows.markdown;
    allConverged = allConverged && rows.converged;
  }
  output::writeTextFile(
      directory / "tables.csv", [&] { return csv; }, *comm);
  output::writeTextFile(
      directory / "tables.md", [&] { return markdown; }, *comm);
  if (comm->getRank() == 0) {
    std::cout << markdown << "written: " << (directory / "tables.csv").string() << " and "
              << (directory / "tables.md").string() << '\n';
  }
  return allConverged;
}

} // namespace epafi::drivers
