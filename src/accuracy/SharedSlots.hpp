#pragma once

/// Values at nodes with one of the materials around them, of which several subdomains of a body have a part.

#include "epafi/accuracy/RecoveredFlux.hpp"

#include <functional>
#include <span>
#include <vector>

namespace epafi::accuracy {

/// Values of a slot of a subdomain, by their numbers on this rank; null: it takes no part.
using SlotValues = std::function<double*(std::size_t subdomain, Eigen::Index slot)>;

/// Adds them up over the subdomains and ranks that share a slot, the same for every number of ranks but for
/// round-off; all of them get the sums. Collective. \param rows  values of each slot
void addSharedSlots(const model::Decomposition& decomposition, std::span<const SubdomainFlux> fluxes,
                    std::size_t rows, const SlotValues& values);

} // namespace epafi::accuracy
