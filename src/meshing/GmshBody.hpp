#pragma once

/// From what a mesh file of Gmsh holds to the arrays of one body.

#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/meshing/MshReader.hpp"

#include <string>
#include <vector>

namespace epafi::meshing {

using GmshBlocks = std::vector<const GmshBlock*>;

/// Whether the group has the geometric entity.
bool holds(const GmshGroup& group, int entity);

std::vector<std::string> namesOf(const std::vector<GmshGroup>& groups);

/// Corners of elements of a kind, by Gmsh's number of it.
std::size_t numCornersOfGmsh(int type);

/// Which facets of the file, in its order, have all their corners in one of the elements.
std::vector<bool> facetsIn(const GmshContents& file, const GmshBlocks& elements);

/// The arrays of a group, or of all elements of the highest dimension if `group` is empty, of the order that
/// the file has. \throws InputError as GmshFile::body()
mesh::MeshArrays arraysOfBody(const GmshContents& file, const std::string& group, mesh::InnerNodes inner);

} // namespace epafi::meshing
