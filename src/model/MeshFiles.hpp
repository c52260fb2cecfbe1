#pragma once

/// The mesh files of a scene, each read once.

#include "epafi/base/Types.hpp"
#include "epafi/fem/GmshFile.hpp"
#include "epafi/scene/Scene.hpp"

#include <map>
#include <string>
#include <tuple>

namespace epafi::model {

/// Rank 0 reads (and, of a geometry, meshes) each file and hands its text to the others: they all have the same mesh,
/// whatever Gmsh does on their machines. Every rank keeps the contents of all files while the object lives.
class MeshFiles {
public:
  /// Reads the files of the scene's bodies. Collective. \throws InputError, the same on all ranks, as fem::textOfMeshFile,
  /// fem::readMsh and fem::GmshFile.
  MeshFiles(const scene::Scene& scene, const Comm& comm);

  /// The file of a body, as its scene says. Precondition: it has one.
  [[nodiscard]] const fem::GmshFile& of(const scene::MeshSource& source) const;

private:
  using Key = std::tuple<std::string, double, int>; ///< file, factor of mesh sizes, refinements
  std::map<Key, fem::GmshFile> files_;
};

} // namespace epafi::model
