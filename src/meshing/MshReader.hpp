#pragma once

/// Mesh files of Gmsh without Gmsh: the formats 2.2 and 4.1 (and 2 and 2.1, which are 2.2 but for
/// partitions), in text or binary. Whatever the bytes, they are read or refused: nothing is taken for
/// granted, since files get cut off and damaged.

#include "epafi/mesh/MeshArrays.hpp"

#include <array>
#include <string>
#include <vector>

namespace epafi::meshing {

/// Elements of one kind on one geometric entity of the file.
struct GmshBlock {
  int entity = 0; ///< its number
  int type = 0;   ///< Gmsh's number of the kind
  std::vector<GlobalOrdinal> tags;
  std::vector<LocalOrdinal> nodes; ///< indices into GmshContents::points, numNodesOfGmsh(type) each
};

/// A physical group; one without a name is called by its number.
struct GmshGroup {
  std::string name;
  std::vector<int> entities; ///< ascending
};

/// What a mesh file holds, as arrays.
struct GmshContents {
  std::string file;
  int dimension = 0;               ///< d: the highest of any element, 2 or 3
  GlobalOrdinal numPartitions = 0; ///< into which the whole mesh was cut; 0: the file does not say
  std::vector<Point> points;
  std::vector<GlobalOrdinal> nodeTags; ///< ascending, none twice
  /// Geometric entity inside which each node lies: its dimension and number. Format 2.2 says neither: −1 and
  /// 0.
  std::vector<std::array<int, 2>> nodeEntities;
  std::vector<GmshBlock> elements;        ///< of dimension d
  std::vector<GmshGroup> groups;          ///< of dimension d
  std::vector<GmshBlock> facets;          ///< of dimension d − 1, on entities that belong to a group
  std::vector<GmshGroup> surfaces;        ///< groups of dimension d − 1
  std::vector<mesh::NamedNodes> nodeSets; ///< of groups of lower dimension still, ascending
};

/// What the text of a mesh file says. It is all in memory, and what is made of it takes about twice as much
/// again. Sections other than those of names, entities, nodes and elements are passed over.
///
/// \param name  the file's name, for errors
/// \throws InputError that names file and line (or byte) if the text is not in one of these formats, promises
/// more than it holds, has sections twice or too few, an element of order 3 or more or whose nodes are not
/// there, or none of dimension 2 or 3
GmshContents readMsh(const std::string& name, std::string text);

/// Nodes of an element of order 1 or 2 by Gmsh's number of its kind; 0 if it is of higher order or unknown.
int numNodesOfGmsh(int type);
/// The kind of order 1 with the same corners, by Gmsh's number. Precondition: numNodesOfGmsh(type) > 0.
int linearKindOfGmsh(int type);
/// 0 to 3. Precondition: numNodesOfGmsh(type) > 0.
int dimensionOfGmsh(int type);
/// What is wrong with a kind of which numNodesOfGmsh() knows nothing, in words that follow the file's name.
std::string unknownKind(int type, GlobalOrdinal element);

} // namespace epafi::meshing
