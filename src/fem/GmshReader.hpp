#pragma once

/// Mesh files: .msh, which we read ourselves, and geometries (.geo), which are programs that Gmsh runs.

#include "epafi/fem/GmshContents.hpp"

#include <string>

namespace epafi::fem {

/// Reads .msh as readMsh() does, and meshes .geo (unless it makes elements itself). Throws InputError if there is no such file,
/// it or Gmsh refuses it, it has no elements of dimension 2 or 3, or some that are not linear; Error if Gmsh is needed and
/// cannot be loaded.
///
/// \param meshSizeFactor  of a .geo that is meshed: by which all its mesh sizes are multiplied (Gmsh's option
///        Mesh.MeshSizeFactor, which the geometry itself can read, for what it does not apply to)
/// \param refinements  how many times every element is split then, into 4 in the plane and 8 in space; new nodes on curved
///        borders lie on the geometry if the file has one
GmshContents readGmshFile(const std::string& file, double meshSizeFactor = 1, int refinements = 0);

} // namespace epafi::fem
