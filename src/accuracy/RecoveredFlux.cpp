#include "epafi/accuracy/RecoveredFlux.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <utility>

namespace epafi::accuracy {
namespace {

using decomposition::Subdomain;
using model::Decomposition;

/// Gives every corner its slot, where there are several materials. Returns the number of slots.
Eigen::Index findSlots(const Subdomain& subdomain, SubdomainFlux& flux) {
  if (flux.elements.regions.empty())
    return subdomain.nodes.size();
  const std::span<const int> corners = flux.elements.numbering->corners();
  const std::size_t perElement = flux.elements.numbering->nodesPerElement();
  std::vector<std::pair<int, GlobalOrdinal>> pairs(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k)
    pairs[k] = {corners[k], flux.elements.regionOf(k / perElement)};
  auto distinct = pairs;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  flux.slots.resize(corners.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
    flux.slots[k] =
        static_cast<int>(std::lower_bound(distinct.begin(), distinct.end(), pairs[k]) - distinct.begin());
  for (const auto& [node, region] : distinct) {
    flux.nodes.push_back(node);
    flux.regions.push_back(region);
  }
  return distinct.size();
}

void addElements(const BodyElements& body, const Subdomain& subdomain, const Eigen::VectorXd& displacement,
                 SubdomainFlux& flux) {
  const int numFluxes = fem::numFluxes(body.physics());
  const std::span<const int> slots = flux.cornerSlots();
  const std::size_t perElement = flux.elements.numbering->nodesPerElement();
  Eigen::MatrixXd sampled;
  body.visit(subdomain, flux.elements, displacement, Points::shape, [&](const ElementView& element) {
    fem::sampledFluxes(body.typeOf(element), element.points, body.physics(), body.materialOf(element.region),
                       element.displacements, sampled, element.state);
    const double measure = mesh::measureOf(body.typeOf(element), element.points);
    sampled *= measure;
    for (std::size_t i = 0; i < element.nodes.size(); ++i) {
      auto sum = flux.values.col(slots[element.number * perElement + i]);
      sum.head(numFluxes) += sampled.col(sampled.cols() == 1 ? 0 : static_cast<Eigen::Index>(i));
      sum[numFluxes] += measure;
    }
  });
}

/// The same on a structured mesh.
void addCongruentElements(const BodyElements& body, const Eigen::VectorXd& displacement,
                          SubdomainFlux& flux) {
  const int numFluxes = fem::numFluxes(body.physics());
  const double measure = body.measure();
  const std::span<const int> slots = flux.cornerSlots();
  const std::size_t perElement = flux.elements.numbering->nodesPerElement();
  for (GlobalOrdinal region = 0; region < body.numRegions(); ++region) {
    const std::vector<std::size_t> which = BodyElements::inRegion(flux.elements, region);
    const Eigen::MatrixXd sampled =
        measure * body.congruentFluxes(region)->sampled(body.gather(flux.elements, which, displacement));
    const Eigen::Index step = sampled.rows() == numFluxes ? 0 : numFluxes;
    for (std::size_t k = 0; k < which.size(); ++k)
      for (std::size_t i = 0; i < perElement; ++i) {
        auto sum = flux.values.col(slots[which[k] * perElement + i]);
        sum.head(numFluxes) += sampled.col(k).segment(i * step, numFluxes);
        sum[numFluxes] += measure;
      }
  }
}

/// A slot at a node that other subdomains of the body touch too.
struct SharedSlot {
  GlobalOrdinal key; ///< a number of its own in the whole problem
  std::size_t subdomain;
  Eigen::Index slot;
};

/// Collective.
std::vector<SharedSlot> sharedSlots(const Decomposition& decomposition,
                                    std::span<const SubdomainFlux> fluxes) {
  GlobalOrdinal regions = 1; // numbers of regions differ between bodies: keys leave room for the most
  for (const SubdomainFlux& flux : fluxes)
    for (const GlobalOrdinal region : flux.regions)
      regions = std::max(regions, region + 1);
  regions = maxOverRanks(*decomposition.problem.comm, regions);
  const std::vector<GlobalOrdinal> firstNode = model::firstNodes(decomposition.bodies);
  std::vector<SharedSlot> shared;
  std::vector<int> numElementsAt;
  for (std::size_t s = 0; s < fluxes.size(); ++s) {
    const Subdomain& subdomain = decomposition.problem.subdomains[s];
    const std::size_t body = subdomain.body;
    const SubdomainFlux& flux = fluxes[s];
    numElementsAt.resize(subdomain.nodes.size());
    decomposition.bodies[body].mesh->numNodeElements(subdomain.nodes, numElementsAt);
    for (std::size_t slot = 0; slot < static_cast<std::size_t>(flux.values.cols()); ++slot) {
      const std::size_t node = flux.nodeOf(slot);
      if (numElementsAt[node] > flux.elements.numbering->numElementsAt()[node])
        shared.push_back({regions * (firstNode[body] + subdomain.nodes[node]) + flux.regionOf(slot), s,
                          static_cast<Eigen::Index>(slot)});
    }
  }
  return shared;
}

/// Adds up shared slots over subdomains and ranks. Collective.
void addShared(const Decomposition& decomposition, std::span<SubdomainFlux> fluxes, std::size_t rows) {
  const RCP<const Comm>& comm = decomposition.problem.comm;
  const std::vector<SharedSlot> shared = sharedSlots(decomposition, fluxes);
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
      data[places[k]] += fluxes[shared[k].subdomain].values(row, shared[k].slot);
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
      fluxes[shared[k].subdomain].values(row, shared[k].slot) = data[places[k]];
  }
}

} // namespace

SubdomainFlux sumFlux(BodyElements& body, const Subdomain& subdomain, const Eigen::VectorXd& displacement) {
  SubdomainFlux flux;
  flux.elements = body.elementsOf(subdomain);
  flux.values.setZero(fem::numFluxes(body.physics()) + 1, findSlots(subdomain, flux));
  if (body.congruentFluxes(0) != nullptr)
    addCongruentElements(body, displacement, flux);
  else
    addElements(body, subdomain, displacement, flux);
  return flux;
}

std::vector<SubdomainFlux> recoverFlux(std::vector<BodyElements>& bodies, const Decomposition& decomposition,
                                       std::span<const Eigen::VectorXd> displacement) {
  const auto& problem = decomposition.problem;
  std::vector<SubdomainFlux> fluxes;
  collectively(*problem.comm, [&] {
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
      fluxes.push_back(sumFlux(bodies[problem.subdomains[s].body], problem.subdomains[s], displacement[s]));
  });
  const int numFluxes = fem::numFluxes(bodies.front().physics()); // all bodies have as many unknowns a node
  addShared(decomposition, fluxes, numFluxes + 1);
  for (SubdomainFlux& flux : fluxes)
    for (Eigen::Index slot = 0; slot < flux.values.cols(); ++slot)
      flux.values.col(slot) *= 1 / flux.values(numFluxes, slot);
  return fluxes;
}

} // namespace epafi::accuracy
