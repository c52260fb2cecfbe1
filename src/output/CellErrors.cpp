#include "epafi/output/CellErrors.hpp"

#include "epafi/base/Maps.hpp"
#include "epafi/output/Slab.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>

namespace epafi::output {

std::vector<double> cellErrors(const SolvedScene& solved, const accuracy::ErrorEstimate& estimate, int body) {
  const auto& problem = solved.decomposition.problem;
  const auto& layout = solved.decomposition.bodies[static_cast<std::size_t>(body)];
  std::vector<GlobalOrdinal> cells;
  std::vector<double> errors;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    if (problem.subdomains[s].body != body)
      continue;
    const auto here = layout.partition->elementsOf(problem.subdomains[s].number - layout.firstSubdomain);
    cells.insert(cells.end(), here.begin(), here.end());
    for (const double squared : estimate.elements[s])
      errors.push_back(std::sqrt(squared));
  }
  const auto source = mapInOrder(cells, problem.comm);
  const auto target = slabMap(layout.mesh->numElements(), problem.comm);
  const Vector mine(source, Teuchos::arrayViewFromVector(errors));
  Vector slab(target);
  slab.doImport(mine, Import(source, target), Tpetra::INSERT);
  const auto values = slab.getData();
  return {values.begin(), values.end()};
}

} // namespace epafi::output
