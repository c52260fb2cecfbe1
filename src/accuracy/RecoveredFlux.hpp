#pragma once

/// A flux (κ∇u or stress) that is continuous inside of each material: of order 1 at a node the mean of the
/// elements around it that are of the node's material there, weighted by their measures (Zienkiewicz, Zhu
/// 1987); of order 2 what polynomials on patches of them have (PatchFlux.hpp), where a body force that begins
/// or ends separates patches as well: derivatives of the flux jump there. The flux itself jumps between
/// elements; from its distance to the recovered one follows how much a finer mesh would change it.

#include "epafi/accuracy/BodyElements.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::accuracy {

/// Values at the nodes of one subdomain: a *slot* is a node with one of the regions around it, which are
/// materials, of order 2 those and body forces.
struct SubdomainFlux {
  SubdomainElements elements;
  Eigen::MatrixXd values; ///< numFluxes × slots, and a last row of ones
  // Where a body has one region, a slot is a node, and these are empty:
  std::vector<int> slots;             ///< of each corner of each element
  std::vector<int> nodes;             ///< of each slot: place among the subdomain's nodes
  std::vector<GlobalOrdinal> regions; ///< of each slot

  /// Slots of all elements' corners, element by element.
  [[nodiscard]] std::span<const int> cornerSlots() const {
    return slots.empty() ? elements.numbering->corners() : std::span<const int>(slots);
  }
  [[nodiscard]] std::size_t nodeOf(std::size_t slot) const {
    return nodes.empty() ? slot : static_cast<std::size_t>(nodes[slot]);
  }
  [[nodiscard]] GlobalOrdinal regionOf(std::size_t slot) const { return regions.empty() ? 0 : regions[slot]; }
};

/// Means, of one subdomain and from its own elements, of any order: Σ w q of those around each slot and, in
/// the last row, Σ w, w their measures. Not collective.
SubdomainFlux sumFlux(BodyElements& body, const decomposition::Subdomain& subdomain,
                      const Eigen::VectorXd& displacement);

/// Of each of this rank's subdomains, the same for every cut and number of ranks but for round-off.
/// \param displacement  u at all positions of each of this rank's subdomains, components in space; it may
/// jump between them
/// Collective; no rank holds more than the values of its own subdomains.
std::vector<SubdomainFlux> recoverFlux(std::vector<BodyElements>& bodies,
                                       const model::Decomposition& decomposition,
                                       std::span<const Eigen::VectorXd> displacement);

} // namespace epafi::accuracy
