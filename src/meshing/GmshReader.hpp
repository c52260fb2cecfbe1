#pragma once

/// The text of mesh files: .msh as it is, geometries (.geo), which are programs that Gmsh runs, as Gmsh
/// meshes and saves them.
///
/// Gmsh's library is loaded when first used: it brings some eighty other libraries along, which a program
/// without geometries need not wait for. It works in a copy of the process (ChildProcess.hpp), which alone
/// ends where a geometry or Gmsh's own mistake ends it, and saves into a folder under TMPDIR (else /tmp),
/// which is removed at once.

#include "epafi/mesh/SizeField.hpp"
#include "epafi/meshing/GmshSession.hpp"

#include <functional>
#include <string>

namespace epafi::meshing {

/// Text of the file that `run` writes while a session has `file` open, under the name that it is given; empty
/// if it writes none. \throws as textOfMeshFile, and what `run` throws
std::string textOfGmsh(const std::string& file, double meshSizeFactor, const StepSizes& sizes,
                       const std::function<void(const GmshSession&, const std::string&)>& run);

/// Text that readMsh() takes; not of several files (isSplit()). A .geo is meshed unless it makes elements
/// itself, and so is a STEP file. Throws InputError if there is no such file, it cannot be read, Gmsh refuses
/// it or makes elements of it that are of order 3 or more; Error if Gmsh is needed and cannot be loaded, or
/// the folder cannot be made.
///
/// \param meshSizeFactor  of a geometry that is meshed: by which all its mesh sizes are multiplied (Gmsh's
/// option Mesh.MeshSizeFactor, which a .geo itself can read, for what it does not apply to)
/// \param refinements  how many times every element is split then, into 4 in the plane and 8 in space; new
/// nodes on curved borders lie on the geometry if the file has one
/// \param order  of the elements that Gmsh makes, 1 or 2: those of order 2 are curved where the geometry is;
/// 0: as the file has it. A .msh that need not be refined is not changed
/// \param sizes  of a STEP file
std::string textOfMeshFile(const std::string& file, double meshSizeFactor = 1, int refinements = 0,
                           int order = 0, const StepSizes& sizes = {});

/// Of a geometry, meshed anew in triangles or tetrahedra of order 2: with these sizes, whatever it says of
/// sizes. Numbers of elements that it gives itself stay (Gmsh's own kernel keeps transfinite curves, layers
/// and quadrilaterals). Empty if its shape is a mesh itself, as that of STL and other merged files is: then
/// it cannot be meshed anew. The same otherwise. \param meshSizeFactor that the geometry can read
std::string textOfGeometry(const std::string& file, double meshSizeFactor, const mesh::SizeField& sizes);

} // namespace epafi::meshing
