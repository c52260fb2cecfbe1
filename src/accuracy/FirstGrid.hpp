#pragma once

/// The coarse mesh that a body on a rectangle or box is refined from.

#include "epafi/mesh/SimplexMesh.hpp"
#include "epafi/scene/Scene.hpp"

namespace epafi::accuracy {

/// Lines (planes) where the scene needs them, at the ends of the body, at the faces of boxes of loads and
/// regions, at point loads and at all these of the bodies that it touches, so that both can match; between
/// them no more than keeps elements no longer than half of the body's least extent, or than the scene's own
/// elements if these are longer. Cut into simplices. Precondition: the body has no mesh file.
mesh::SimplexMesh firstGrid(const scene::Scene& scene, std::size_t body);

} // namespace epafi::accuracy
