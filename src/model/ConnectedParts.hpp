#pragma once

/// Repair of a partition whose parts are not connected.

#include "epafi/fem/Mesh.hpp"

#include <vector>

namespace epafi::model {

/// Makes every part of a mesh connected through facets of elements (edges in 2-D, faces in 3-D): each piece
/// that is not the largest of its part goes to the neighbouring part with which it shares most facets. Parts
/// may become empty. Where the mesh itself has pieces, these remain as they are.
///
/// \param[in,out] part  of every element, ≥ 0
void makeConnected(const fem::Mesh& mesh, std::vector<int>& part);

} // namespace epafi::model
