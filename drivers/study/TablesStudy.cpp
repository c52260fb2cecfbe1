#include "Studies.hpp"
#include "Table.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/scene/ModelProblem.hpp"

#include <Teuchos_Comm.hpp>

#include <array>

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

/// Our numbers, and the paper's under the same names after "paper_". The plain method is the paper's; others
/// have a preconditioner, and active sets where they are the default.
Row solveCell(const Cell& cell, const RCP<const Comm>& comm) {
  const scene::Scene scene = scene::modelProblem(cell.coercive, cell.subdomainsPerSide,
                                                 cell.subdomainsPerSide * cell.elementsPerSide);
  Teuchos::ParameterList method, plainMethod;
  method.set("Algorithm", "MPRGP");
  plainMethod.sublist("Preconditioner").set("Type", "none");
  const simulation::SceneRun run = simulation::solveScene(scene, plainMethod, comm);
  const simulation::SceneRun preconditioned = simulation::solveScene(scene, method, comm);
  const simulation::SceneRun byDefault = simulation::solveScene(scene, {}, comm);
  const auto& problem = run.decomposition->problem;
  const qp::SolveReport& report = run.solver->report();
  return {{"problem", cell.coercive ? "coercive" : "semicoercive"},
          {"H_inverse", cell.subdomainsPerSide},
          {"H_over_h", cell.elementsPerSide},
          {"primal_dimension", problem.primalDimension},
          {"paper_primal_dimension", cell.primalDimension},
          {"dual_dimension", problem.dualDimension()},
          {"paper_dual_dimension", cell.dualDimension},
          {"corners", problem.numCrosspoints},
          {"paper_corners", cell.corners},
          {"cg_iterations", report.counts.conjugateGradient},
          {"paper_cg_iterations", cell.iterations},
          {"expansion_steps", report.counts.expansion},
          {"proportioning_steps", report.counts.proportioning},
          {"hessian_multiplications", report.counts.hessianMultiplications},
          {"outer_iterations", report.counts.outer},
          {"relative_projected_gradient", run.solution.relativeProjectedGradient},
          {"setup_seconds", run.solver->times().setup},
          {"solve_seconds", run.solver->times().solve},
          {"norm_multiplications", run.solver->dualProblem().norm().multiplications},
          {"preconditioned_multiplications", preconditioned.solver->report().counts.hessianMultiplications},
          {"default_multiplications", byDefault.solver->report().counts.hessianMultiplications},
          {"converged", report.status == qp::Status::converged}};
}

std::string lineOf(const Row& row) {
  std::vector<std::string> entries{row.text("problem")};
  for (const char* column : {"H_inverse", "H_over_h"})
    entries.push_back(count(row.number(column)));
  for (const std::string column : {"primal_dimension", "dual_dimension", "corners", "cg_iterations"})
    entries.push_back(count(row.number(column)) + " / " + count(row.number("paper_" + column)));
  for (const char* column :
       {"expansion_steps", "proportioning_steps", "outer_iterations", "hessian_multiplications",
        "preconditioned_multiplications", "default_multiplications"})
    entries.push_back(count(row.number(column)));
  return markdownLine(entries);
}

} // namespace

bool studyTables(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table(
      "problem,H_inverse,H_over_h,primal_dimension,dual_dimension,corners,cg_iterations,expansion_steps,"
      "proportioning_steps,hessian_multiplications,outer_iterations,relative_projected_gradient,setup_"
      "seconds,"
      "solve_seconds,paper_cg_iterations,norm_multiplications,preconditioned_multiplications,"
      "default_multiplications");
  std::string markdown = markdownHeading(
      "problem | 1/H | H/h | primal (ours / paper) | dual (ours / paper) | corners (ours / paper) | CG steps "
      "(ours / "
      "paper) | expansions | proportionings | outer | products with F | with Dirichlet preconditioner | by "
      "default");
  bool allConverged = true;
  for (const Cell& cell : paper) {
    if (quick && cell.elementsPerSide > 8)
      continue;
    table.rows.push_back(solveCell(cell, comm));
    markdown += lineOf(table.rows.back());
    allConverged = allConverged && table.rows.back().number("converged") == 1;
  }
  tell(*comm, markdown);
  writeFiles(directory, {{"tables.csv", table.csv()}, {"tables.md", markdown}}, *comm);
  return allConverged;
}

} // namespace epafi::drivers
