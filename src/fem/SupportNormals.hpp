#pragma once

/// The directions in which a surface that slides along itself is held.

#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fem {

/// A node of a surface and an outward normal there, of length 1.
struct NodeNormal {
  GlobalOrdinal node = 0;
  Eigen::Vector3d normal;
};

/// The normals of a surface, by ascending node; several at a node on an edge of the surface.
///
/// Facets that join in nodes and whose normals agree to 1e-6 make one plane, and all its nodes have its one
/// normal, the mean by area: the rigid motions along it stay free exactly, however the file rounds the
/// points. Where a surface bends, by less than 40° from facet to facet at a node, a node has the mean of its
/// facets' normals by area, which approximates the curved surface's normal; planes that meet at more than
/// that are an edge, and hold along both normals. An axis that a normal meets to 1e-12 is that normal.
std::vector<NodeNormal> supportNormals(const mesh::Mesh& mesh, const mesh::Surface& surface);

} // namespace epafi::fem
