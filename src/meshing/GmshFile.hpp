#pragma once

/// Meshes of bodies from a file of Gmsh, formats 2.2 and 4.1 in text or binary, or from a geometry (.geo)
/// that Gmsh meshes.
///
/// A body is a physical group of the file's highest dimension d; its named surfaces are the physical groups
/// of dimension d − 1 as far as they bound it, its element groups the other groups of dimension d as far as
/// they lie in it. Groups without a name are called by their number.
///
/// Nothing is collective: every rank that makes an object holds the whole file. A mesh that only many ranks
/// can hold is read from a file for each part (model/SplitFiles.hpp). A million hexahedra take 330 MB while
/// they are read (by Gmsh 500), of which the object keeps 80, and each body made of them 140 (tetrahedra:
/// 130, 35 and 70).

#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"
#include "epafi/meshing/MeshSource.hpp"
#include "epafi/meshing/MshReader.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace epafi::meshing {

class GmshFile {
public:
  /// Reads the file, once for all its bodies. Throws InputError that names the file if it is not there, is
  /// damaged, Gmsh refuses it, its elements are of order 3 or more, or a facet or node of a named surface
  /// belongs to no element; Error if the Gmsh library cannot be loaded.
  explicit GmshFile(const std::string& file);
  explicit GmshFile(GmshContents contents);

  [[nodiscard]] const std::string& file() const { return contents_.file; }
  /// 2 or 3: the highest dimension of any element.
  [[nodiscard]] int dimension() const { return contents_.dimension; }
  /// Physical groups that can be bodies.
  [[nodiscard]] std::vector<std::string> groupNames() const;

  /// The mesh of a group, or of all elements of the highest dimension if `group` is empty. Nodes and elements
  /// are numbered in the order of their numbers in the file. Throws InputError if there is no such group, it
  /// mixes shapes of elements, or UnstructuredMesh refuses it.
  /// \param order  of the mesh, 1 or 2, whatever the file has (MeshOrder.hpp); 0: as the file has it.
  /// \param inner  whether elements of 8 and 20 nodes become those of 9 and 27
  [[nodiscard]] mesh::UnstructuredMesh body(const std::string& group, int order = 0,
                                            mesh::InnerNodes inner = mesh::InnerNodes::added) const;
  /// That of a scene's body, whose file this is, with the pieces that it names.
  [[nodiscard]] mesh::UnstructuredMesh body(const MeshSource& source, int order,
                                            mesh::InnerNodes inner = mesh::InnerNodes::added) const;

  /// Whether there is anything that body() would make a mesh of.
  [[nodiscard]] bool hasElements(const std::string& group) const;
  /// Into how many files the whole mesh was cut; 0: the file does not say.
  [[nodiscard]] GlobalOrdinal numPartitions() const { return contents_.numPartitions; }
  /// Calls visit(surface, corners) for each facet of each named surface of any body: the surface's name, and
  /// the numbers that the corners have in the file; and visit(set, node) for each node of each named set.
  void
  visitFacets(const std::function<void(const std::string&, std::span<const GlobalOrdinal>)>& visit) const;

private:
  GmshContents contents_;
};

} // namespace epafi::meshing
