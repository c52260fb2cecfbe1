#include "AccuracyCase.hpp"
#include "AccuracyPeers.hpp"
#include "AccuracyReport.hpp"
#include "Effectivity.hpp"
#include "Places.hpp"
#include "Studies.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <string>

namespace epafi::drivers {
namespace {

void append(const std::vector<Row>& rows, Table& table) {
  table.rows.insert(table.rows.end(), rows.begin(), rows.end());
}

void measureProblem(const AccuracyProblem& problem, const std::filesystem::path& directory, bool quick,
                    const RCP<const Comm>& comm, Table& table) {
  const std::string name = problem.name + (problem.order() > 1 ? ", order 2" : "");
  tell(*comm, name + ": reference");
  const AccuracyReference reference(problem, comm);
  const double budget = quick ? 0.5 : 10; // seconds a mesh
  const std::string& text = caseText("accuracy");
  for (int level = 0; level < problem.meshes; ++level) {
    tell(*comm, name + ": mesh " + std::to_string(level + 1) + " of " + std::to_string(problem.meshes));
    const std::string variants = problem.order() > 1 ? "quadratic" : "variants";
    append(measureVariants(problem, level, reference, expandCases(text, variants, quick), budget, comm),
           table);
  }
  if (problem.order() > 1)
    return;
  std::vector<Row> ladders =
      measureVariants(problem, problem.meshes - 1, reference, expandCases(text, "ladders", quick), 0, comm);
  for (Row& row : ladders) { // one round: counts and errors
    for (const char* time : {"seconds", "finest_seconds", "solve_seconds"})
      row[time] = notMeasured;
    addDigits(row);
  }
  append(ladders, table);
  std::vector<Row> peers;
  collectively(*comm, [&] { peers = peerRows(directory, problem, reference); });
  append(peers, table);
}

} // namespace

bool studyAccuracy(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table = accuracyTable();
  for (const AccuracyProblem& problem : accuracyProblems(quick))
    measureProblem(problem, directory, quick, comm, table);
  markFront(table);
  writeFiles(directory, {{"accuracy.csv", table.csv()}}, *comm); // the next part may take long
  Table effectivity = effectivityTable();
  for (Case& one : expandCases(caseText("accuracy"), "effectivity", quick)) {
    tell(*comm, "effectivity: " + one.name);
    append(measureEffectivity(one.name, one.list.get("Reference", 0.0), one.list.get("Mesh Size", 1.0),
                              sceneDirectory(), comm),
           effectivity);
  }
  writeFiles(directory, {{"accuracy_effectivity.csv", effectivity.csv()}}, *comm);
  const std::string report = accuracyReport(table) + "Estimated and true error:\n\n" +
                             effectivityReport(effectivity) + "\n" + digitsReport(table);
  tell(*comm, "\n" + report);
  writeFiles(directory, {{"accuracy.md", report}}, *comm);
  return std::all_of(table.rows.begin(), table.rows.end(),
                     [](const Row& row) { return row.text("status") == "Converged"; });
}

} // namespace epafi::drivers
