#pragma once

/// Facets of meshes, as places, normals and distances are asked of them, and by how much they are off the
/// smooth surfaces that they stand for.

#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/Mesh.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace epafi::assembly {

struct FacetPoint {
  Eigen::Vector3d place, normal; ///< the latter of length 1
  double stretch;                ///< area over that of the reference facet
};

/// A facet and what it can tell.
struct Facet {
  mesh::CellType type;
  mesh::NodalColumns<3> points;
  std::array<Point, 2> box;
  std::vector<GlobalOrdinal> nodes; ///< by their numbers, of bodies that may share some
  double sag = 0;                   ///< by how much it is off the smooth surface

  template <int dim>
  [[nodiscard]] FacetPoint at(const mesh::Shape<dim>& shape, const mesh::Coordinates<dim>& xi) const {
    const auto sample = shape.sampleAt(xi);
    const Eigen::Matrix<double, 3, dim> tangents = mesh::derivatives(points, sample);
    Eigen::Vector3d normal;
    if constexpr (dim == 1)
      normal = {tangents(1), -tangents(0), 0};
    else
      normal = tangents.col(0).cross(tangents.col(1));
    return {points * sample.values, normal.normalized(), normal.norm()};
  }
  /// The first coordinate counts on edges.
  [[nodiscard]] FacetPoint at(const Eigen::Vector2d& xi) const {
    return mesh::withFacetShape(
        type, [&]<int dim>(const mesh::Shape<dim>& shape) { return at<dim>(shape, xi.head<dim>()); });
  }
};

template <int dim>
bool isInside(const mesh::Shape<dim>& shape, const mesh::Coordinates<dim>& xi) {
  constexpr double rounding = 1e-6;
  return shape.isSimplex ? xi.minCoeff() >= -rounding && xi.sum() <= 1 + rounding
                         : xi.cwiseAbs().maxCoeff() <= 1 + rounding;
}

/// What lies on a line.
struct Foot {
  double distance;        ///< from its start
  Eigen::Vector3d normal; ///< of length 1
};

/// Where the line from x along a direction of length 1 meets the facet.
std::optional<Foot> footOn(const Facet& facet, const Eigen::Vector3d& x, const Eigen::Vector3d& direction);

/// A place on a facet and the share of the reference facet that it stands for.
struct Sample {
  Eigen::Vector2d xi;
  double weight;
};

/// Centres of even pieces, and nodes.
std::vector<Sample> samplesOf(mesh::CellType type);

/// What the facets of a face are off the smooth surface that they stand for: straight ones by what circles
/// through their edges are, h θ/8.
void setSags(const mesh::Surface& surface, std::vector<Facet>& facets);

} // namespace epafi::assembly
