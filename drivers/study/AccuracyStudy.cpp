#include "AccuracyStudy.hpp"

#include "AccuracyCase.hpp"
#include "AccuracyPeers.hpp"
#include "AccuracyReport.hpp"
#include "Effectivity.hpp"
#include "Places.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <iostream>
#include <string>

namespace epafi::drivers {
namespace {

void tell(const Comm& comm, const std::string& text) {
  if (comm.getRank() == 0)
    std::cout << text << std::endl;
}

void measureProblem(const AccuracyProblem& problem, const std::filesystem::path& directory, bool quick,
                    const RCP<const Comm>& comm, AccuracyTable& table) {
  tell(*comm, problem.name + ": reference");
  const AccuracyReference reference(problem, comm);
  const double budget = quick ? 0.5 : 10; // seconds a mesh
  for (int level = 0; level < problem.meshes; ++level) {
    tell(*comm,
         problem.name + ": mesh " + std::to_string(level + 1) + " of " + std::to_string(problem.meshes));
    for (const AccuracyRow& row :
         measureVariants(problem, level, reference, variantsOnMeshes(), budget, comm))
      table.add(row);
  }
  for (AccuracyRow row :
       measureVariants(problem, problem.meshes - 1, reference, variantsOfTolerance(quick), 0, comm)) {
    row.seconds = row.finestSeconds = row.solveSeconds = AccuracyRow::unknown; // one round: counts and errors
    table.add(row);
  }
  std::vector<AccuracyRow> peers;
  collectively(*comm, [&] { peers = peerRows(directory, problem, reference); });
  for (const AccuracyRow& row : peers)
    table.add(row);
}

} // namespace

bool studyAccuracy(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  const auto write = [&](const char* name, const std::string& text) {
    output::writeTextFile(
        directory / name, [&] { return text; }, *comm);
    tell(*comm, "written: " + (directory / name).string());
  };
  AccuracyTable table;
  for (const AccuracyProblem& problem : accuracyProblems(quick))
    measureProblem(problem, directory, quick, comm, table);
  table.markFront();
  write("accuracy.csv", table.csv()); // the next part may take long
  std::vector<EffectivityRow> effectivity;
  for (const EffectivityCase& which : effectivityCases(quick)) {
    tell(*comm, "effectivity: " + which.scene);
    for (const EffectivityRow& row : measureEffectivity(which, sceneDirectory(), comm))
      effectivity.push_back(row);
  }
  write("accuracy_effectivity.csv", effectivityCsv(effectivity));
  const std::string report =
      "The default beside the front:\n\n" + frontReport(table) + "\nBalanced stopping:\n\n" +
      balanceReport(table) + "\nNested starts:\n\n" + nestedReport(table) +
      "\nErrors of the meshes, the iteration's at 1e-10:\n\n" + convergenceReport(table) +
      "\nAll variants, finest mesh:\n\n" + variantsReport(table) + "\nEstimated and true error:\n\n" +
      effectivityReport(effectivity) + "\nDigits of the iteration:\n\n" + digitsReport(table);
  tell(*comm, "\n" + report);
  write("accuracy.md", report);
  return std::all_of(table.rows().begin(), table.rows().end(),
                     [](const AccuracyRow& row) { return row.status == "Converged"; });
}

} // namespace epafi::drivers
