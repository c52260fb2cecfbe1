#pragma once

/// Elements to test with: of every type, of every form.

#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"
#include "epafi/scene/Body.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace epafi::test {

inline constexpr std::array linearCellTypes{mesh::CellType::triangle,    mesh::CellType::quadrilateral,
                                            mesh::CellType::tetrahedron, mesh::CellType::pyramid,
                                            mesh::CellType::prism,       mesh::CellType::hexahedron};
inline constexpr std::array allCellTypes{
    mesh::CellType::triangle,       mesh::CellType::quadrilateral, mesh::CellType::tetrahedron,
    mesh::CellType::hexahedron,     mesh::CellType::pyramid,       mesh::CellType::prism,
    mesh::CellType::pyramid13,      mesh::CellType::prism15,       mesh::CellType::triangle6,
    mesh::CellType::quadrilateral9, mesh::CellType::tetrahedron10, mesh::CellType::hexahedron27,
    mesh::CellType::quadrilateral8, mesh::CellType::hexahedron20};

/// Physics that go with a type of cell, membranes apart.
inline std::vector<fem::Physics> elasticPhysics(mesh::CellType type) {
  if (dimensionOf(type) == 3)
    return {fem::Physics::elasticity3d};
  return {fem::Physics::planeStrain, fem::Physics::planeStress};
}

/// Physics that go with a type of cell.
inline std::vector<fem::Physics> allPhysics(mesh::CellType type) {
  auto all = elasticPhysics(type);
  if (dimensionOf(type) == 2)
    all.push_back(fem::Physics::membrane);
  return all;
}

inline const fem::Material material{
    .conductivity = 3, .youngsModulus = 10, .poissonsRatio = 0.25, .thickness = 0.5};

inline std::span<const double> spanOf(const Eigen::VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

inline Eigen::Vector3d vectorOf(const Point& point) {
  return {point[0], point[1], point[2]};
}
inline Point pointOf(const Eigen::Vector3d& vector) {
  return {vector[0], vector[1], vector[2]};
}

/// The nodes of a cell whose shape functions of order 1 these corners have.
inline std::vector<Point> withAllNodes(mesh::CellType type, const std::vector<Point>& corners) {
  return withShape(type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    std::vector<Point> points;
    for (int node = 0; node < shape.numNodes; ++node) {
      const mesh::NodalValues values = referenceShape<dim>(withOrder(type, 1)).values(shape.node(node));
      Point& point = points.emplace_back();
      for (std::size_t a = 0; a < corners.size(); ++a)
        for (std::size_t d = 0; d < 3; ++d)
          point[d] += values[a] * corners[a][d];
    }
    return points;
  });
}

/// The cell of side 1 at the origin.
inline std::vector<Point> unitCell(mesh::CellType type) {
  if (orderOf(type) == 2)
    return withAllNodes(type, unitCell(withOrder(type, 1)));
  switch (type) {
  case mesh::CellType::triangle:
    return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  case mesh::CellType::quadrilateral:
    return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  case mesh::CellType::tetrahedron:
    return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  case mesh::CellType::pyramid:
    return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
  case mesh::CellType::prism:
    return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  default:
    break;
  }
  return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
}

/// A cell with its corners moved by `map`.
template <class Map>
std::vector<Point> mapped(std::vector<Point> points, const Map& map) {
  for (Point& point : points)
    point = pointOf(map(vectorOf(point)));
  return points;
}

/// Numbers in [−1, 1], the same on every machine.
class SignedRandomNumbers {
public:
  explicit SignedRandomNumbers(std::uint32_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_()) / 2147483647.5 - 1; }
  Eigen::Vector3d vector() {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }

private:
  std::mt19937 engine_;
};

/// The unit cell with each corner moved by up to 0.15 along each axis: faces of hexahedra are warped. Of
/// order 2 the nodes follow, and are moved by up to 0.02 themselves: edges are curved.
inline std::vector<Point> distortedCell(mesh::CellType type, std::uint32_t seed) {
  SignedRandomNumbers random(seed);
  const double most = orderOf(type) == 1 ? 0.15 : 0.02;
  const std::vector<Point> points =
      orderOf(type) == 1 ? unitCell(type) : withAllNodes(type, distortedCell(withOrder(type, 1), seed + 1));
  return mapped(points, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    Eigen::Vector3d moved = x + most * random.vector();
    if (dimensionOf(type) == 2)
      moved[2] = 0;
    return moved;
  });
}

/// No parallelogram or parallelepiped, but with plane faces: the image of the unit cell under a projective
/// map.
inline std::vector<Point> planeFacedCell(mesh::CellType type) {
  const bool inSpace = dimensionOf(type) == 3;
  return mapped(unitCell(type), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    Eigen::Vector3d image = Eigen::Vector3d(2 * x[0] + 0.3 * x[1], 1.5 * x[1] - 0.2 * x[0], 0.8 * x[2]) +
                            Eigen::Vector3d(x[2] * 0.1, x[2] * 0.4, x[0] * 0.3);
    if (!inSpace)
      image[2] = 0;
    return image / (1 + 0.3 * x[0] - 0.2 * x[1] + 0.25 * x[2]);
  });
}

/// The cell inside out: two neighbouring corners exchanged, or below and above. Of order 2 the edges become
/// straight.
inline std::vector<Point> inverted(mesh::CellType type, std::vector<Point> points) {
  if (orderOf(type) == 2) {
    points.resize(numCornersOf(type));
    return withAllNodes(type, inverted(withOrder(type, 1), std::move(points)));
  }
  const auto half = static_cast<std::ptrdiff_t>(points.size() / 2);
  if (type == mesh::CellType::hexahedron || type == mesh::CellType::prism)
    std::swap_ranges(points.begin(), points.begin() + half, points.begin() + half);
  else if (type == mesh::CellType::pyramid)
    std::swap(points[1], points[3]);
  else if (type == mesh::CellType::quadrilateral)
    std::reverse(points.begin(), points.end());
  else
    std::swap(points[0], points[1]);
  return points;
}

/// Rotation by an angle about z, in space about an oblique axis.
inline Eigen::Matrix3d rotation(mesh::CellType type, double angle) {
  const Eigen::Vector3d axis =
      dimensionOf(type) == 2 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(1, -2, 3).normalized();
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Corners of a facet.
inline std::vector<Point> facetPoints(mesh::CellType /*type*/, std::span<const Point> points,
                                      const mesh::Facet& facet) {
  std::vector<Point> corners;
  for (const int place : facet)
    corners.push_back(points[place]);
  return corners;
}

/// Adds a facet's load to that of the element.
inline void addFacetLoad(mesh::CellType /*type*/, const mesh::Facet& facet, const Eigen::VectorXd& facetLoad,
                         Eigen::VectorXd& load) {
  const auto number = static_cast<Eigen::Index>(facet.size()), components = facetLoad.size() / number;
  for (Eigen::Index i = 0; i < number; ++i)
    load.segment(facet[i] * components, components) += facetLoad.segment(i * components, components);
}

/// The field x ↦ gradient·x + (1, −2, 3) at the corners, `components` values a node.
inline Eigen::VectorXd linearField(std::span<const Point> points, int components,
                                   const Eigen::Matrix3d& gradient) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(points.size()) * components);
  for (std::size_t a = 0; a < points.size(); ++a)
    values.segment(static_cast<Eigen::Index>(a) * components, components) =
        (gradient * vectorOf(points[a]) + Eigen::Vector3d(1, -2, 3)).head(components);
  return values;
}

/// Sum over the nodes of a load with `components` values a node.
inline Eigen::Vector3d resultant(const Eigen::VectorXd& load, int components) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index row = 0; row < load.size(); ++row)
    sum[row % components] += load[row];
  return sum;
}

} // namespace epafi::test
