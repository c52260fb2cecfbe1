#include "epafi/mesh/ElementGeometry.hpp"

#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/JacobianBound.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace epafi::mesh {
namespace {

void noteJacobian(ElementShape& shape, double value, int corner) {
  if (value < shape.leastJacobian) {
    shape.leastJacobian = value;
    shape.corner = corner;
  }
}

/// Of a simplex of order 1 the determinant is the same everywhere; of a quadrilateral it is linear, so that
/// its least value lies at a corner. Of order 2 samples come first: most elements that are not sound fail
/// there.
template <int dim>
void measure(const Shape<dim>& reference, std::span<const Point> points, ElementShape& shape) {
  const auto corners = relativeCorners<dim>(points);
  if (reference.gaussSamples().size() > 1) {
    int node = 0;
    for (const auto& sample : reference.nodeSamples())
      noteJacobian(shape, reference.measure * ElementMap(corners, sample).determinant(), node++);
  }
  for (const auto& sample : reference.fineSamples()) {
    const double inside = ElementMap(corners, sample).determinant();
    shape.measure += sample.weight * inside; // exact
    noteJacobian(shape, reference.measure * inside, -1);
  }
  if (reference.order > 1)
    noteJacobian(shape, reference.measure * leastDeterminant(reference.type, points), -1);
}

/// ∫wN_a. \param weight  of the values of the shape functions at a point
template <int dim, class Weight>
void addShares(const Shape<dim>& shape, std::span<const Point> points,
               const typename Shape<dim>::Samples& samples, std::span<double> shares, const Weight& weight) {
  const auto corners = relativeCorners<dim + 1>(points);
  Eigen::Map<Eigen::VectorXd> sums(shares.data(), shape.numNodes);
  sums.setZero();
  for (const auto& sample : samples)
    sums += (sample.weight * weight(sample.values) * facetNormal(corners, sample).norm()) * sample.values;
}

} // namespace

Point centreOf(std::span<const Point> points) {
  Point centre{0, 0, 0};
  for (const Point& point : points)
    for (std::size_t i = 0; i < 3; ++i)
      centre[i] += point[i];
  for (double& coordinate : centre)
    coordinate /= static_cast<double>(points.size());
  return centre;
}

std::array<Point, 2> boxOf(std::span<const Point> points, double margin) {
  Point lower = points[0], upper = points[0];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Point& point : points) {
      lower[axis] = std::min(lower[axis], point[axis]);
      upper[axis] = std::max(upper[axis], point[axis]);
    }
    lower[axis] -= margin;
    upper[axis] += margin;
  }
  return {lower, upper};
}

double diameterOf(std::span<const Point> points) {
  double square = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0;
      for (std::size_t d = 0; d < 3; ++d)
        sum += (points[i][d] - points[j][d]) * (points[i][d] - points[j][d]);
      square = std::max(square, sum);
    }
  return std::sqrt(square);
}

double measureOf(CellType type, std::span<const Point> points) {
  return withShape(type, [&]<int dim>(const Shape<dim>& shape) {
    const auto corners = relativeCorners<dim>(points);
    double measure = 0;
    for (const auto& sample : shape.fineSamples())
      measure += sample.weight * ElementMap(corners, sample).determinant();
    return measure;
  });
}

void nodalShares(CellType facet, std::span<const Point> points, std::span<double> shares) {
  withFacetShape(facet, [&](const auto& shape) {
    addShares(shape, points, shape.fineSamples(), shares, [](const auto&) { return 1.0; });
  });
}

void revolvedShares(CellType edge, std::span<const Point> points, std::span<double> shares) {
  const Shape<1>& shape = referenceShape<1>(edge);
  addShares(shape, points, shape.revolvedSamples(), shares,
            [&](const auto& values) { return circumferenceAt(points, values); });
}

Eigen::Vector3d areaVector(CellType facet, std::span<const Point> points) {
  return withFacetShape(facet, [&]<int dim>(const Shape<dim>& shape) {
    const auto corners = relativeCorners<dim + 1>(points);
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    for (const auto& sample : shape.fineSamples())
      vector.head<dim + 1>() += sample.weight * facetNormal(corners, sample);
    return vector;
  });
}

void nodalNormals(CellType facet, std::span<const Point> points, std::vector<Eigen::Vector3d>& normals) {
  const Eigen::Vector3d area = areaVector(facet, points);
  normals.assign(points.size(), area);
  withFacetShape(facet, [&]<int dim>(const Shape<dim>& shape) {
    const auto corners = relativeCorners<dim + 1>(points);
    for (std::size_t a = 0; a < normals.size() && shape.order > 1; ++a) {
      normals[a].setZero();
      normals[a].template head<dim + 1>() = facetNormal(corners, shape.nodeSamples()[a]);
      normals[a] *= area.norm() / normals[a].norm();
    }
  });
}

ElementShape shapeOf(CellType type, std::span<const Point> corners) {
  ElementShape shape;
  shape.diameter = diameterOf(corners);
  shape.leastJacobian = std::numeric_limits<double>::infinity();
  withShape(type, [&](const auto& reference) { measure(reference, corners, shape); });
  return shape;
}

} // namespace epafi::mesh
