#pragma once

/// Faces of bodies as a picture: what --list names by numbers.

#include "epafi/assembly/MeshFaces.hpp"

#include <span>
#include <string>

namespace epafi::drivers {

/// An SVG: bodies in space from two opposite sides, with the numbers of the faces that one sees, a body a
/// colour, faces in pairs darker; the name of a face shows under the pointer. \param meshes of the bodies
std::string pictureOf(const assembly::MeshFaces& faces, std::span<const mesh::Mesh* const> meshes);

} // namespace epafi::drivers
