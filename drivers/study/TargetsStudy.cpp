#include "AccuracyTargets.hpp"
#include "CaseTable.hpp"
#include "Places.hpp"
#include "Studies.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>

namespace epafi::drivers {

bool studyTargets(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table = targetsTable();
  for (Case& one : expandCases(caseText("accuracy"), "targets", quick)) {
    tell(*comm, "targets: " + one.name);
    std::vector<double> targets;
    for (double target = one.list.get("Largest", 0.05); target >= 0.99 * one.list.get<double>("Least");
         target *= 0.5)
      targets.push_back(target);
    const std::vector<Row> rows = measureTargets(one.name, one.list.get("Order", 0), targets,
                                                 one.list.get<double>("Reference"), sceneDirectory(), comm);
    table.rows.insert(table.rows.end(), rows.begin(), rows.end());
    const std::string report = targetsReport(table);
    tell(*comm, "\n" + report);
    writeFiles(directory, {{"targets.csv", table.csv()}, {"targets.md", report}}, *comm);
  }
  constexpr double tenth = 1.1;
  return std::all_of(table.rows.begin(), table.rows.end(), [](const Row& row) {
    return row.number("met") == 1 && row.number("true_error") <= tenth * row.number("target");
  });
}

} // namespace epafi::drivers
