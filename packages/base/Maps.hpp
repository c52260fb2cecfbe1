#pragma once

/// Maps of given indices.

#include "epafi/base/Types.hpp"

#include <span>
#include <vector>

namespace epafi {

/// Of these indices, sorted, each once. Several ranks may have the same ones. Collective.
RCP<const Map> makeMap(std::vector<GlobalOrdinal> indices, const RCP<const Comm>& comm);

/// Of these indices in the order given. Precondition: none stands twice on a rank. Collective.
RCP<const Map> mapInOrder(const std::vector<GlobalOrdinal>& indices, const RCP<const Comm>& comm);

/// The rank of each index, which may stand more than once. Precondition: one rank has it. Collective.
std::vector<int> ownersOf(const Map& map, std::span<const GlobalOrdinal> indices);

} // namespace epafi
