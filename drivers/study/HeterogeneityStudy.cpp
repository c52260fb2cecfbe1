#include "CaseTable.hpp"
#include "Studies.hpp"
#include "Table.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/qp/operators/SpectrumEstimate.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Teuchos_Comm.hpp>

#include <iostream>

namespace epafi::drivers {
namespace {

/// Solves with the default parameters but for Adaptive Constraints/Use = `use`, and estimates the condition
/// of what the iteration works on, by Lanczos. `constraints` are the adaptive ones, each a product with F in
/// the set-up. Collective.
Row measure(const Case& which, const std::string& use, const RCP<const Comm>& comm) {
  Teuchos::ParameterList parameters;
  parameters.sublist("Adaptive Constraints").set("Use", use);
  const simulation::SceneRun run =
      simulation::solveScene(scene::readScene(which.scene(), which.name), parameters, comm);
  const fetidp::DualProblem& dual = run.solver->dualProblem();
  const qp::SpectrumEstimate spectrum = qp::estimateSpectrum(*dual.hessian(), dual.preconditioner());
  return {{"bodies", which.name},
          {"pattern", which.parameter},
          {"cut", which.list.sublist("Decomposition").isParameter("Parts") ? "METIS" : "grid"},
          {"jump", which.value},
          {"adaptive", use},
          {"constraints", run.result.solve.numAdaptiveConstraints},
          {"hessian_multiplications", run.solver->report().counts.hessianMultiplications},
          {"condition", spectrum.largest / spectrum.smallest},
          {"smallest_eigenvalue", spectrum.smallest},
          {"largest_eigenvalue", spectrum.largest},
          {"converged", run.solver->report().status == qp::Status::converged},
          {"energy", plain(run.solution.energy, 12)},
          {"setup_seconds", run.solver->times().setup},
          {"solve_seconds", run.solver->times().solve}};
}

} // namespace

bool studyHeterogeneity(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table(
      "bodies,pattern,cut,jump,adaptive,constraints,hessian_multiplications,condition,smallest_eigenvalue,"
      "largest_eigenvalue,converged,energy,setup_seconds,solve_seconds");
  if (comm->getRank() == 0)
    std::cout << markdownHeading(
        "bodies | pattern | cut | jump | products without | κ | products | κ | constraints");
  bool allConverged = true;
  for (const Case& one : expandCases(caseText("heterogeneity"), "heterogeneity", quick)) {
    std::vector<std::string> entries;
    for (const char* use : {"no", "auto"}) {
      const Row row = measure(one, use, comm);
      const bool converged = row.number("converged") == 1;
      if (entries.empty())
        entries = {row.text("bodies"), row.text("pattern"), row.text("cut"), plain(row.number("jump"), 3)};
      entries.push_back(plain(row.number("hessian_multiplications")) + (converged ? "" : " (not converged)"));
      entries.push_back(plain(row.number("condition"), 3));
      table.rows.push_back(row);
    }
    entries.push_back(plain(table.rows.back().number("constraints")));
    allConverged = allConverged && table.rows.back().number("converged") == 1;
    if (comm->getRank() == 0)
      std::cout << markdownLine(entries) << std::flush;
  }
  writeFiles(directory, {{"heterogeneity.csv", table.csv()}}, *comm);
  return allConverged;
}

} // namespace epafi::drivers
