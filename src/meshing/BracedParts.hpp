#pragma once

/// Parts of a body that stay in form although their elements are integrated by few points.

#include "epafi/mesh/Mesh.hpp"

#include <vector>

namespace epafi::meshing {

/// Makes every element braced by others of its part, where the whole mesh does: it goes to the neighbouring
/// part with which it shares most facets, or else both parts become one. Connected parts stay connected.
/// Precondition: quadrilaterals or hexahedra.
///
/// \param[in,out] part  of every element, ≥ 0
void makeBraced(const mesh::Mesh& mesh, std::vector<int>& part);

} // namespace epafi::meshing
