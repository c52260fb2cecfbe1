#include "epafi/accuracy/RecoveredFlux.hpp"

#include "epafi/accuracy/PatchFlux.hpp"
#include "epafi/accuracy/SharedSlots.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <utility>

namespace epafi::accuracy {
namespace {

using decomposition::Subdomain;
using model::Decomposition;

/// Gives every corner its slot, where there are several regions. Returns the number of slots.
/// \param regions  of each element; empty: one
Eigen::Index findSlots(const Subdomain& subdomain, std::span<const GlobalOrdinal> regions,
                       SubdomainFlux& flux) {
  if (regions.empty())
    return subdomain.nodes.size();
  const std::span<const int> corners = flux.elements.numbering->corners();
  const std::size_t perElement = flux.elements.numbering->nodesPerElement();
  std::vector<std::pair<int, GlobalOrdinal>> pairs(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k)
    pairs[k] = {corners[k], regions[k / perElement]};
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

} // namespace

SubdomainFlux sumFlux(BodyElements& body, const Subdomain& subdomain, const Eigen::VectorXd& displacement) {
  SubdomainFlux flux;
  flux.elements = body.elementsOf(subdomain);
  flux.values.setZero(fem::numFluxes(body.physics()) + 1, findSlots(subdomain, flux.elements.regions, flux));
  if (body.congruentFluxes(0) != nullptr)
    addCongruentElements(body, displacement, flux);
  else
    addElements(body, subdomain, displacement, flux);
  return flux;
}

std::vector<SubdomainFlux> recoverFlux(std::vector<BodyElements>& bodies, const Decomposition& decomposition,
                                       std::span<const Eigen::VectorXd> displacement) {
  const auto& problem = decomposition.problem;
  const int numFluxes = fem::numFluxes(bodies.front().physics()); // all bodies have as many unknowns a node
  std::vector<SubdomainFlux> fluxes;
  std::vector<FluxPatches> patches;
  std::size_t most = 0; // values of a patch, of any body
  for (const BodyElements& body : bodies)
    most = std::max(most, body.order() == 1 ? 0 : numPatchSums(body, numFluxes));
  collectively(*problem.comm, [&] {
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
      BodyElements& body = bodies[problem.subdomains[s].body];
      if (body.order() == 1) {
        fluxes.push_back(sumFlux(body, problem.subdomains[s], displacement[s]));
        patches.emplace_back();
        continue;
      }
      SubdomainFlux flux;
      flux.elements = body.elementsOf(problem.subdomains[s]);
      const Eigen::Index slots = findSlots(problem.subdomains[s], body.smoothParts(flux.elements), flux);
      flux.values.setZero(numFluxes + 1, slots);
      patches.push_back(sumPatches(body, problem.subdomains[s], displacement[s], flux, most));
      fluxes.push_back(std::move(flux));
    }
  });
  addSharedSlots(decomposition, fluxes, numFluxes + 1, [&](std::size_t s, Eigen::Index slot) {
    return patches[s].ofSlot.empty() ? fluxes[s].values.col(slot).data() : nullptr;
  });
  if (most > 0)
    addSharedSlots(decomposition, fluxes, most, [&](std::size_t s, Eigen::Index slot) {
      const int patch = patches[s].ofSlot.empty() ? -1 : patches[s].ofSlot[slot];
      return patch < 0 ? nullptr : patches[s].sums.col(patch).data();
    });
  collectively(*problem.comm, [&] {
    for (std::size_t s = 0; s < fluxes.size(); ++s) {
      if (patches[s].ofSlot.empty())
        for (Eigen::Index slot = 0; slot < fluxes[s].values.cols(); ++slot)
          fluxes[s].values.col(slot) *= 1 / fluxes[s].values(numFluxes, slot);
      else
        fitPatches(bodies[problem.subdomains[s].body], problem.subdomains[s], displacement[s], patches[s],
                   fluxes[s]);
    }
  });
  return fluxes;
}

} // namespace epafi::accuracy
