#pragma once

/// The nodes of a surface with their normals and shares of its area.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace epafi::contact {

/// Where nodes lie, by their numbers.
using NodePoints = std::function<Point(GlobalOrdinal)>;

struct SurfaceNodes {
  std::vector<GlobalOrdinal> nodes; ///< ascending
  /// What moves with them: each itself; those that only a finer surface would have, the nodes around.
  std::vector<std::vector<NodeShare>> shares;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d>
      normals; ///< outwards, of length 1: the mean of the facets' normals there by area
  /// ∫N_a: what of the area (in the plane: length; of solids of revolution ∫2πr N_a) a node has, so that an
  /// even pressure p gives forces p · area
  std::vector<double> areas;
  std::vector<double> spacings; ///< of the nodes around each
  /// What a facet has to do with its nodes.
  struct Facet {
    std::vector<std::size_t> nodes; ///< places, corners first
    int numCorners = 2;
    std::vector<double> shares; ///< ∫N of each
    Eigen::Vector3d normal;     ///< of length 1
  };
  std::vector<Facet> facets;
  /// Where a surface bends sharply, Σ of the facets' normals by area of each face that meets there, any two
  /// of which are more than `sharpBend` apart; empty where it does not: `normals` says all.
  std::vector<std::vector<Eigen::Vector3d>> faces;
};

/// Cosine of the angle beyond which facets at a node belong to different faces: 30 degrees.
constexpr double sharpBend = 0.86602540378443865;

/// \param order  2: of facets of order 1 also the points where those of order 2 would have nodes, between the
/// corners, with numbers beyond those of the surface; 0: that of the surface
/// \param isOfRevolution  about the y-axis: areas are those of the whole circumference
SurfaceNodes surfaceNodes(const NodePoints& pointAt, const mesh::Surface& surface, int order = 0,
                          bool isOfRevolution = false);

} // namespace epafi::contact
