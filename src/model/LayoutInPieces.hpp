#pragma once

/// Bodies of which each rank holds its own subdomains and what is around them.

#include "epafi/model/BodyLayout.hpp"

namespace epafi::model {

/// layoutBodies() with Meshes::pieces: the meshes of one file each are read by rank 0, those of several files
/// by all ranks, and all are dealt out. Collective. \throws InputError likewise.
std::vector<BodyLayout> layoutInPieces(const scene::Scene& scene, const Comm& comm);

} // namespace epafi::model
