#pragma once

/// A body as the XML gives it: what it consists of, where its mesh comes from, and how it is cut.

#include "epafi/fem/Solid.hpp"
#include "epafi/meshing/MeshSource.hpp"

#include <array>

namespace epafi::scene {

/// How a body is cut into subdomains.
struct Decomposition {
  /// Along lines of the mesh, or by METIS on the graph of its elements.
  enum class Method { grid, metis };
  Method method = Method::grid;
  std::array<int, 3> counts = {2, 2, 2}; ///< grid: subdomains in x, y and, in space, z
  int parts = 0;                         ///< metis: number of parts; 0: as many as suit
  int cluster =
      -1; ///< subdomains that share crosspoints, one body's: so many; 0: all of it; -1: by their number
};

struct Body : fem::Solid {
  meshing::MeshSource mesh;
  Decomposition decomposition;
};

/// Whether it is a membrane on a rectangle, whose surfaces are the four edges.
inline bool isMembraneOnRectangle(const Body& body) {
  return body.physics == fem::Physics::membrane && body.mesh.file.empty();
}

} // namespace epafi::scene
