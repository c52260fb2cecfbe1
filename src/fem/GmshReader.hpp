#pragma once

/// What a mesh file holds, as arrays, without Gmsh.

#include "epafi/fem/MeshArrays.hpp"

#include <string>
#include <vector>

namespace epafi::fem {

/// Elements of one kind on one geometric entity of the file.
struct GmshBlock {
  int entity = 0; ///< its number in the file
  int type = 0;   ///< Gmsh's number of the kind, a linear one
  std::vector<GlobalOrdinal> tags;
  std::vector<LocalOrdinal> nodes; ///< indices into GmshContents::points, numNodesOfGmsh(type) each
};

/// A physical group; one without a name is called by its number.
struct GmshGroup {
  std::string name;
  std::vector<int> entities; ///< ascending
};

struct GmshContents {
  std::string file;
  int dimension = 0; ///< d: the highest of any element, 2 or 3
  std::vector<Point> points;
  std::vector<GlobalOrdinal> nodeTags; ///< ascending
  /// Geometric entity inside which each node lies: its dimension and number.
  std::vector<std::array<int, 2>> nodeEntities;
  std::vector<GmshBlock> elements; ///< of dimension d
  std::vector<GmshGroup> groups;   ///< of dimension d
  std::vector<GmshBlock> facets;   ///< of dimension d − 1, on entities that belong to a group
  std::vector<GmshGroup> surfaces; ///< groups of dimension d − 1
  std::vector<GmshGroup> lesser;   ///< groups of lower dimension still, without entities: for errors
};

/// Nodes of a linear element by Gmsh's number of its kind; 0 if it is not linear or unknown.
int numNodesOfGmsh(int type);

/// Reads .msh, meshes .geo (unless it holds elements already). Throws InputError if there is no such file, Gmsh refuses it,
/// it has no elements of dimension 2 or 3, or some that are not linear.
///
/// \param meshSizeFactor  of a .geo that is meshed: by which all its mesh sizes are multiplied (Gmsh's option
///        Mesh.MeshSizeFactor, which the geometry itself can read, for what it does not apply to)
GmshContents readGmshFile(const std::string& file, double meshSizeFactor = 1);

} // namespace epafi::fem
