#pragma once

/// Deals out a body that rank 0 has whole, so that afterwards each rank holds its own subdomains' elements, those around their
/// nodes and those at the mesh's named surfaces (fem/MeshPart.hpp).

#include "epafi/model/BodyLayout.hpp"

#include <functional>

namespace epafi::model {

/// \param whole    the body, on rank 0; null on the others
/// \param partsOf  the parts of a rank, the same function on all ranks
/// \param piece    gets this rank's mesh and partition
/// Rank 0 cuts and sends one piece after the other. Collective.
void dealOut(const BodyLayout* whole, const std::function<Share(int rank)>& partsOf, const Comm& comm,
             BodyLayout& piece);

} // namespace epafi::model
