#pragma once

/// The same scene on meshes of half the size.

#include "epafi/scene/Scene.hpp"

namespace epafi::accuracy {

/// Twice as many elements along each axis; the elements of mesh files are split into 4 (plane) or 8 (space).
/// As many times more subdomains, so that these keep their number of elements and the method its pace. Coarse
/// nodes are fine nodes.
scene::Scene refined(scene::Scene scene);

} // namespace epafi::accuracy
