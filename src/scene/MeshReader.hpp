#pragma once

/// Where the mesh of a body comes from, and how it is cut, out of the body's list.

#include "epafi/scene/Body.hpp"
#include "epafi/scene/ListReader.hpp"

#include <string>

namespace epafi::scene {

/// \param dimension  of the body, 2 or 3
/// \throws InputError if a size, count or name makes no sense, what the kind of source needs is missing, or
/// what it has no use for is given
meshing::MeshSource readMesh(const ListReader& list, int dimension);

/// \param list  the body's list Decomposition, complete
/// \param body  its name
/// \throws InputError if there are more parts than elements, or a grid for a mesh file
Decomposition readDecomposition(const ListReader& list, const std::string& body,
                                const meshing::MeshSource& mesh, int dimension);

} // namespace epafi::scene
