#include "CaseTable.hpp"
#include "Places.hpp"
#include "RefinementCosts.hpp"
#include "Studies.hpp"

namespace epafi::drivers {

bool studyRefinement(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table = refinementTable();
  for (const Case& one : expandCases(caseText("accuracy"), "refinement", quick)) {
    tell(*comm, "refinement: " + one.name);
    for (const Row& row : measureRefinement(one.name, one.list, sceneDirectory(), comm))
      table.rows.push_back(row);
    writeFiles(directory, {{"refinement.csv", table.csv()}}, *comm);
  }
  return true;
}

} // namespace epafi::drivers
