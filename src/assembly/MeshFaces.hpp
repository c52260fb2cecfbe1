#pragma once

/// Bodies that are meshed already as an assembly: its faces are the smooth pieces of their boundaries
/// (mesh/SmoothPieces.hpp).

#include "epafi/assembly/Assembly.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <span>
#include <string>
#include <vector>

namespace epafi::assembly {

struct MeshedBody {
  std::string name;
  const mesh::Mesh* mesh = nullptr;
  /// Of its nodes, if bodies with nodes of the same number hang together there; empty: none does.
  std::vector<GlobalOrdinal> nodeNumbers{};
};

/// The facets of one face.
struct MeshFace {
  int body = 0;
  mesh::Surface surface;
};

/// In the order of their numbers, which count through all bodies.
struct MeshFaces {
  Assembly assembly;           ///< without pairs; the unit is empty
  std::vector<MeshFace> faces; ///< of each of its faces

  /// Indices of the faces that have facets of a named surface, ascending; none if there is no such surface.
  [[nodiscard]] std::vector<int> facesIn(std::span<const MeshedBody> bodies, int body,
                                         const std::string& surface) const;
};

/// Pieces that are a named surface have its name, others a place in words. Of structured meshes the sides.
/// Precondition: meshes are whole.
MeshFaces meshFacesOf(std::span<const MeshedBody> bodies);

} // namespace epafi::assembly
