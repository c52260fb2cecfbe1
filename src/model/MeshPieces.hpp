#pragma once

/// Deals out a body's elements, so that afterwards each rank holds those of its own subdomains, those around
/// their nodes and those at the mesh's named surfaces (mesh/MeshPart.hpp), whoever had them before. No rank
/// holds more of the whole body than its named surfaces with the elements there, and which parts touch.

#include "epafi/meshing/LooseMesh.hpp"
#include "epafi/model/BodyLayout.hpp"

namespace epafi::model {

/// \param loose  the body's elements, on any ranks
/// \param own    this rank's parts; they ascend with the ranks
/// \param piece  gets this rank's mesh and partition
/// Collective. \throws InputError, the same on all ranks, if a named facet lies inside the body, more than
/// two elements share a facet, two share its corners alone, a node has two places, or parts hang on others by
/// less than facets.
void dealOut(meshing::LooseMesh loose, Share own, const Comm& comm, BodyLayout& piece);

} // namespace epafi::model
