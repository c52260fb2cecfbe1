#include "epafi/contact/FacetView.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <cstddef>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;

/// Nodes this near to where straight edges would have them, beside the facet's size, are there.
constexpr double straight = 1e-10;

/// Places of the corners of a facet's pieces, between all its nodes if it is of order 2.
std::vector<std::vector<int>> piecesOf(mesh::CellType type, bool isStraight) {
  using mesh::CellType;
  if (isStraight || mesh::orderOf(type) == 1) {
    std::vector<int> corners;
    for (int c = 0; c < numCornersOf(type); ++c)
      corners.push_back(c);
    return {corners};
  }
  if (type == CellType::line3)
    return {{0, 2}, {2, 1}};
  if (type == CellType::triangle6)
    return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  if (type == CellType::quadrilateral8)
    return {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {6, 3, 7}, {4, 5, 6, 7}};
  return {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}};
}

/// Where the nodes would lie if edges were straight and the centre were that of the corners.
Eigen::Matrix3Xd straightened(mesh::CellType type, const Eigen::Matrix3Xd& points) {
  Eigen::Matrix3Xd result = points;
  if (mesh::orderOf(type) == 1)
    return result;
  const std::span<const int> edges = edgesOf(type);
  const Eigen::Index corners = numCornersOf(type);
  for (std::size_t e = 0; 2 * e < edges.size(); ++e)
    result.col(corners + e) = (points.col(edges[2 * e]) + points.col(edges[2 * e + 1])) / 2;
  if (type == mesh::CellType::quadrilateral9)
    result.col(8) = points.leftCols<4>().rowwise().mean();
  return result;
}

} // namespace

ViewPlane ViewPlane::across(const Vector3d& origin, const Vector3d& normal, int dimension) {
  ViewPlane plane{origin, {}};
  if (dimension == 2) // along an edge the body lies on the left
    plane.axes << -normal[1], 0, normal[0], normal[0], 0, normal[1], 0, 1, 0;
  else {
    const Vector3d first = normal.unitOrthogonal();
    plane.axes << first, normal.cross(first), normal;
  }
  return plane;
}

FacetView::FacetView(mesh::CellType type, std::span<const Point> points)
    : type_(type), points_(3, points.size()) {
  for (std::size_t a = 0; a < points.size(); ++a)
    points_.col(a) = Vector3d(points[a][0], points[a][1], points[a][2]);
  centre_ = points_.leftCols(numCornersOf(type)).rowwise().mean();
  const Vector3d vector = mesh::areaVector(type, points);
  area_ = vector.norm();
  normal_ = vector / area_;
  diameter_ = mesh::diameterOf(points);
  const bool isStraight =
      (straightened(type, points_) - points_).cwiseAbs().maxCoeff() <= straight * diameter_;
  isAffine_ = isStraight;
  if (isAffine_ && numCornersOf(type) == 4)
    isAffine_ =
        (points_.col(0) - points_.col(1) + points_.col(2) - points_.col(3)).norm() <= straight * diameter_;
  for (const std::vector<int>& corners : piecesOf(type, isStraight)) {
    auto& piece = pieces_.emplace_back();
    for (const int corner : corners)
      piece.emplace_back(points_.col(corner));
  }
}

int FacetView::degree() const {
  return mesh::orderOf(type_) * (numCornersOf(type_) == 4 ? 2 : 1);
}

std::optional<FacetView::Sight> FacetView::at(const Eigen::Vector2d& seen, const ViewPlane& plane) const {
  return mesh::withFacetShape(type_, [&]<int dim>(const mesh::Shape<dim>& shape) -> std::optional<Sight> {
    constexpr int maxSteps = 30;
    using Point = mesh::Coordinates<dim>;
    const mesh::NodalColumns<3> relative = points_.colwise() - plane.origin;
    const mesh::NodalColumns<dim> flat =
        plane.axes.template leftCols<dim>().transpose().lazyProduct(relative);
    Point xi = shape.centre();
    for (int step = 0; step < maxSteps; ++step) {
      const auto sample = shape.sampleAt(xi);
      const Point off = flat.lazyProduct(sample.values) - seen.head<dim>();
      const Eigen::Matrix<double, dim, dim> jacobian = mesh::derivatives(flat, sample);
      const double determinant = jacobian.determinant();
      if (std::abs(determinant) <= 1e-14 * std::pow(diameter_, dim))
        return std::nullopt;
      const Point change = jacobian.inverse() * off;
      xi -= change;
      if (change.norm() <= 1e-10 || // the next one would be 1e-20
          (isAffine_ && step == 0)) {
        const auto last = shape.sampleAt(xi);
        const Eigen::Matrix<double, 3, dim> tangents = mesh::derivatives(relative, last);
        double size = 0;
        if constexpr (dim == 1)
          size = tangents.norm();
        else
          size = tangents.col(0).cross(tangents.col(1)).norm();
        return Sight{last.values, relative * last.values, size / std::abs(determinant)};
      }
    }
    return std::nullopt;
  });
}

} // namespace epafi::contact
