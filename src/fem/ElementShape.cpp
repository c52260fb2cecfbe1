#include "epafi/fem/ElementShape.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace epafi::fem {
namespace {

using Vector3 = Eigen::Vector3d;

Vector3 vectorOf(const Point& point) {
  return {point[0], point[1], point[2]};
}

/// The z-component of a × b.
double cross(const Vector3& a, const Vector3& b) {
  return a[0] * b[1] - a[1] * b[0];
}

double triangleArea(std::span<const Point> p) {
  return cross(vectorOf(p[1]) - vectorOf(p[0]), vectorOf(p[2]) - vectorOf(p[0])) / 2;
}

double tetrahedronVolume(std::span<const Point> p) {
  const Vector3 origin = vectorOf(p[0]);
  return (vectorOf(p[1]) - origin).cross(vectorOf(p[2]) - origin).dot(vectorOf(p[3]) - origin) / 6;
}

void noteJacobian(ElementShape& shape, double value, int corner) {
  if (value < shape.leastJacobian) {
    shape.leastJacobian = value;
    shape.corner = corner;
  }
}

/// The determinant of a bilinear map is linear, so that its least value lies at a corner.
void measureQuadrilateral(std::span<const Point> p, ElementShape& shape) {
  shape.measure = cross(vectorOf(p[2]) - vectorOf(p[0]), vectorOf(p[3]) - vectorOf(p[1])) / 2;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3 corner = vectorOf(p[i]);
    noteJacobian(shape, cross(vectorOf(p[(i + 1) % 4]) - corner, vectorOf(p[(i + 3) % 4]) - corner),
                 static_cast<int>(i));
  }
}

/// Corners of the unit cube in the order of a hexahedron's nodes.
constexpr std::array<std::array<double, 3>, 8> cube{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

using Gradients = Eigen::Matrix<double, 8, 3>;

/// Gradients of the trilinear shape functions at a point of the unit cube.
Gradients gradientsAt(const std::array<double, 3>& at) {
  Gradients gradients;
  for (std::size_t i = 0; i < 8; ++i) {
    std::array<double, 3> factor{}, sign{};
    for (std::size_t k = 0; k < 3; ++k) {
      factor[k] = cube[i][k] > 0 ? at[k] : 1 - at[k];
      sign[k] = cube[i][k] > 0 ? 1 : -1;
    }
    gradients.row(static_cast<Eigen::Index>(i)) << sign[0] * factor[1] * factor[2],
        factor[0] * sign[1] * factor[2], factor[0] * factor[1] * sign[2];
  }
  return gradients;
}

/// The same at the corners, and at the Gauss points nearest to them.
struct CubeGradients {
  std::array<Gradients, 8> corners, gauss;

  CubeGradients() {
    const double offset = 0.5 / std::sqrt(3.0);
    for (std::size_t i = 0; i < 8; ++i) {
      std::array<double, 3> inside{};
      for (std::size_t k = 0; k < 3; ++k)
        inside[k] = cube[i][k] > 0 ? 0.5 + offset : 0.5 - offset;
      corners[i] = gradientsAt(cube[i]);
      gauss[i] = gradientsAt(inside);
    }
  }
};

void measureHexahedron(std::span<const Point> p, ElementShape& shape) {
  static const CubeGradients gradients;
  Eigen::Matrix<double, 3, 8> x;
  for (std::size_t i = 0; i < 8; ++i)
    x.col(static_cast<Eigen::Index>(i)) = vectorOf(p[i]);
  for (std::size_t i = 0; i < 8; ++i) {
    const double inside = (x * gradients.gauss[i]).determinant();
    shape.measure += inside / 8; // exact: the determinant is quadratic in each coordinate
    noteJacobian(shape, (x * gradients.corners[i]).determinant(), static_cast<int>(i));
    noteJacobian(shape, inside, -1);
  }
}

} // namespace

ElementShape shapeOf(CellType type, std::span<const Point> corners) {
  ElementShape shape;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      shape.diameter = std::max(shape.diameter, (vectorOf(corners[i]) - vectorOf(corners[j])).squaredNorm());
  shape.diameter = std::sqrt(shape.diameter);
  shape.leastJacobian = std::numeric_limits<double>::infinity();
  switch (type) {
  case CellType::triangle:
    shape.measure = shape.leastJacobian = triangleArea(corners);
    break;
  case CellType::quadrilateral:
    measureQuadrilateral(corners, shape);
    break;
  case CellType::tetrahedron:
    shape.measure = shape.leastJacobian = tetrahedronVolume(corners);
    break;
  case CellType::hexahedron:
    measureHexahedron(corners, shape);
    break;
  }
  return shape;
}

} // namespace epafi::fem
