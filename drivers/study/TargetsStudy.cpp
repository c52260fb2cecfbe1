#include "AccuracyTargets.hpp"
#include "CaseTable.hpp"
#include "Places.hpp"
#include "Studies.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <string>

namespace epafi::drivers {

bool studyTargets(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table = targetsTable();
  for (const Case& one : expandCases(caseText("accuracy"), "targets", quick)) {
    tell(*comm, "targets: " + one.name);
    std::vector<double> targets;
    const double least = std::stod(one.parameter);
    for (const double target : {0.05, 0.02, 0.01, 0.005, 0.002, 0.001})
      if (target >= least)
        targets.push_back(target);
    const std::vector<Row> rows =
        measureTargets(one.name, 0, targets, one.list.get<double>("Reference"), sceneDirectory(), comm);
    table.rows.insert(table.rows.end(), rows.begin(), rows.end());
    const std::string report = targetsReport(table);
    tell(*comm, "\n" + report);
    writeFiles(directory, {{"accuracy_targets.csv", table.csv()}, {"accuracy_targets.md", report}}, *comm);
  }
  constexpr double tenth = 1.1;
  return std::all_of(table.rows.begin(), table.rows.end(), [](const Row& row) {
    return row.number("met") == 1 && row.number("true_error") <= tenth * row.number("target");
  });
}

} // namespace epafi::drivers
