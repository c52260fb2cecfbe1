#pragma once

/// Faces of different bodies that lie close together, on the facets of their meshes, curved where these are
/// of order 2. Facets are off round surfaces: by how much, each pair says.

#include "epafi/assembly/MeshFaces.hpp"
#include "epafi/assembly/PairSearch.hpp"

namespace epafi::assembly {

/// Fills in pairs and near misses as findPairs() does of a STEP file. Where bodies share nodes they are no
/// pair. A pair is also one that may be near as far as facets can tell.
void findPairs(std::span<const MeshedBody> bodies, const PairSearch& search, MeshFaces& faces);

} // namespace epafi::assembly
