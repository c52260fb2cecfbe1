#pragma once

#include "epafi/model/Decompose.hpp"

#include <vector>

namespace epafi::model {

/// The number, in the whole, assembled problem of a scene, of the value at each position (node × components +
/// component, as Subdomain::prescribed has them) of each of this rank's subdomains: body after body, node
/// after node, component after component. It is what linear::UnassembledOperator takes. Not collective.
std::vector<std::vector<GlobalOrdinal>> globalUnknowns(const Decomposition& decomposition);

} // namespace epafi::model
