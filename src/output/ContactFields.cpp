#include "epafi/output/ContactFields.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::output {
namespace {

std::vector<double> rowsOf(const Vector& whole, const Import& toSlab) {
  Vector slab(toSlab.getTargetMap());
  slab.doImport(whole, toSlab, Tpetra::INSERT);
  const auto data = slab.getData();
  return {data.begin(), data.end()};
}

} // namespace

ContactFields gatherContactFields(const decomposition::Decomposition& decomposition,
                                  const fetidp::ContactSolution& solution, int contact) {
  const auto& problem = decomposition.problem;
  const auto& pair = decomposition.contacts[static_cast<std::size_t>(contact)];
  const fem::Mesh& mesh = *decomposition.bodies[static_cast<std::size_t>(pair.firstBody)].mesh;

  ContactFields fields;
  fields.numRows = pair.numRows();
  fields.rows = evenShare(pair.numRows(), *problem.comm);
  std::vector<GlobalOrdinal> multipliers;
  for (GlobalOrdinal k = fields.rows.first; k < fields.rows.first + fields.rows.count; ++k) {
    multipliers.push_back(pair.firstRow + k);
    const fem::Point point = mesh.point(pair.firstNodes[static_cast<std::size_t>(k)]);
    fields.points.insert(fields.points.end(), point.begin(), point.end());
  }

  const Teuchos::ArrayView<const GlobalOrdinal> indices(multipliers.data(),
                                                        static_cast<Teuchos::Ordinal>(multipliers.size()));
  const auto slab =
      rcp(new Map(static_cast<Tpetra::global_size_t>(pair.numRows()), indices, 0, problem.comm));
  const Import toSlab(problem.multiplierMap, slab);
  fields.initialGap = rowsOf(*problem.gap, toSlab);
  fields.gap = rowsOf(*solution.slack, toSlab);
  fields.multiplier = rowsOf(*solution.multiplier, toSlab);
  for (const double value : rowsOf(*solution.active, toSlab))
    fields.active.push_back(value > 0.5 ? 1 : 0);
  return fields;
}

} // namespace epafi::output
