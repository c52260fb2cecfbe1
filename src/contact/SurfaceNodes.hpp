#pragma once

/// The nodes of a surface with their normals and shares of its area.

#include "epafi/fem/Mesh.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::contact {

struct SurfaceNodes {
  std::vector<GlobalOrdinal> nodes; ///< ascending
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d>
      normals; ///< outwards, of length 1: the mean of the facets' normals there by area
  std::vector<double>
      areas; ///< ∫N_a: what of the area (in the plane: length) a node has, so that an even pressure p gives forces p · area
  std::vector<double> spacings; ///< of the nodes around each
};

SurfaceNodes surfaceNodes(const fem::Mesh& mesh, const fem::Surface& surface);

} // namespace epafi::contact
