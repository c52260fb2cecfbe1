#pragma once

/// Several surfaces of a body as one.

#include "epafi/mesh/Mesh.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace epafi::contact {

struct UnitedSurface {
  mesh::Surface surface;          ///< facets of the first, then those that the next ones have beside
  std::vector<std::size_t> parts; ///< of each facet, which one it is of
};

/// \param names  of surfaces that the mesh has, at least one
UnitedSurface unite(const mesh::Mesh& mesh, std::span<const std::string> names);

/// Turns the normals of all facets round.
void turnOver(mesh::Surface& surface);

} // namespace epafi::contact
