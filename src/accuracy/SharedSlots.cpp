#include "epafi/accuracy/SharedSlots.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Maps.hpp"

#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <utility>

namespace epafi::accuracy {
namespace {

using model::Decomposition;

/// A slot at a node that other subdomains of the body touch too.
struct SharedSlot {
  GlobalOrdinal key; ///< a number of its own in the whole problem
  double* values;
};

/// Collective.
std::vector<SharedSlot> sharedSlots(const Decomposition& decomposition, std::span<const SubdomainFlux> fluxes,
                                    const SlotValues& values) {
  GlobalOrdinal regions = 1; // numbers of regions differ between bodies: keys leave room for the most
  for (const SubdomainFlux& flux : fluxes)
    for (const GlobalOrdinal region : flux.regions)
      regions = std::max(regions, region + 1);
  regions = maxOverRanks(*decomposition.problem.comm, regions);
  const std::vector<GlobalOrdinal> firstNode = model::firstNodes(decomposition.bodies);
  std::vector<SharedSlot> shared;
  std::vector<int> numElementsAt;
  for (std::size_t s = 0; s < fluxes.size(); ++s) {
    const decomposition::Subdomain& subdomain = decomposition.problem.subdomains[s];
    const std::size_t body = subdomain.body;
    const SubdomainFlux& flux = fluxes[s];
    numElementsAt.resize(subdomain.nodes.size());
    decomposition.bodies[body].mesh->numNodeElements(subdomain.nodes, numElementsAt);
    for (std::size_t slot = 0; slot < static_cast<std::size_t>(flux.values.cols()); ++slot) {
      const std::size_t node = flux.nodeOf(slot);
      if (numElementsAt[node] == flux.elements.numbering->numElementsAt()[node])
        continue;
      if (double* own = values(s, static_cast<Eigen::Index>(slot)))
        shared.push_back({regions * (firstNode[body] + subdomain.nodes[node]) + flux.regionOf(slot), own});
    }
  }
  return shared;
}

} // namespace

void addSharedSlots(const Decomposition& decomposition, std::span<const SubdomainFlux> fluxes,
                    std::size_t rows, const SlotValues& values) {
  const RCP<const Comm>& comm = decomposition.problem.comm;
  const std::vector<SharedSlot> shared = sharedSlots(decomposition, fluxes, values);
  std::vector<GlobalOrdinal> keys;
  for (const SharedSlot& slot : shared)
    keys.push_back(slot.key);
  const RCP<const Map> here = makeMap(std::move(keys), comm);
  std::vector<LocalOrdinal> places;
  for (const SharedSlot& slot : shared)
    places.push_back(here->getLocalElement(slot.key));
  MultiVector sums(here, rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto data = sums.getDataNonConst(row);
    for (std::size_t k = 0; k < shared.size(); ++k)
      data[places[k]] += shared[k].values[row];
  }
  if (comm->getSize() > 1) {
    const RCP<const Map> owned = Tpetra::createOneToOne(here);
    const Export plan(here, owned);
    MultiVector total(owned, rows);
    total.doExport(sums, plan, Tpetra::ADD);
    sums.doImport(total, plan, Tpetra::REPLACE);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const auto data = sums.getData(row);
    for (std::size_t k = 0; k < shared.size(); ++k)
      shared[k].values[row] = data[places[k]];
  }
}

} // namespace epafi::accuracy
