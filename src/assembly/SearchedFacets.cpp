#include "epafi/assembly/SearchedFacets.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace epafi::assembly {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::optional<Foot> footOn(const Facet& facet, const Vector3d& x, const Vector3d& direction) {
  return mesh::withFacetShape(facet.type, [&]<int dim>(const mesh::Shape<dim>& shape) -> std::optional<Foot> {
    mesh::Coordinates<dim> xi = shape.centre();
    double distance = 0;
    constexpr int mostSteps = 20;
    for (int step = 0; step < mostSteps; ++step) {
      const auto sample = shape.sampleAt(xi);
      const Eigen::Matrix<double, 3, dim> tangents = mesh::derivatives(facet.points, sample);
      Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity(); // in the plane nothing happens along z
      matrix.template leftCols<1>() = -direction;
      matrix.template rightCols<dim>() = tangents;
      if constexpr (dim == 1)
        matrix.col(1) = Vector3d::UnitZ();
      const Eigen::FullPivLU<Eigen::Matrix3d> factors(matrix);
      if (!factors.isInvertible())
        return std::nullopt;
      const Vector3d change = factors.solve(facet.points * sample.values - x - distance * direction);
      distance -= change[0];
      xi -= change.template tail<dim>();
      constexpr double settled = 1e-10, lost = 10;
      if (xi.norm() > lost)
        return std::nullopt;
      if (change.template tail<dim>().norm() > settled)
        continue;
      if (!isInside<dim>(shape, xi))
        return std::nullopt;
      return Foot{distance, facet.template at<dim>(shape, xi).normal};
    }
    return std::nullopt;
  });
}

std::vector<Sample> samplesOf(mesh::CellType type) {
  return mesh::withFacetShape(type, []<int dim>(const mesh::Shape<dim>& shape) {
    constexpr int perAxis = 4;
    std::vector<Sample> samples;
    const double weight = shape.measure / mesh::power(perAxis, dim);
    for (int i = 0; i < perAxis; ++i)
      for (int j = 0; j < (dim == 1 ? 1 : perAxis); ++j) {
        if (!shape.isSimplex)
          samples.push_back({Vector2d(2 * i + 1, 2 * j + 1) / perAxis - Vector2d(1, 1), weight});
        else if (dim == 1)
          samples.push_back({Vector2d(i + 0.5, 0) / perAxis, weight});
        else if (i + j < perAxis)
          samples.push_back({Vector2d(i + 1 / 3.0, j + 1 / 3.0) / perAxis, weight});
        if (shape.isSimplex && dim == 2 && i + j < perAxis - 1)
          samples.push_back({Vector2d(i + 2 / 3.0, j + 2 / 3.0) / perAxis, weight});
      }
    for (int node = 0; node < shape.numNodes; ++node) {
      samples.push_back({Vector2d(0, 0), 0});
      samples.back().xi.head<dim>() = shape.node(node);
    }
    return samples;
  });
}

namespace {

double angleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// What makes a facet's own edges deviate from a circle: straight ones are not looked at here.
double ownSag(const Facet& facet, const std::vector<Vector3d>& normals) {
  if (mesh::orderOf(facet.type) == 1)
    return 0;
  const int corners = mesh::numCornersOf(facet.type);
  double sag = 0;
  for (int c = 0; c < corners; ++c) {
    const int next = (c + 1) % corners;
    const double half = angleBetween(normals[index(c)], normals[index(next)]) / 2;
    const double length = (facet.points.col(c) - facet.points.col(next)).norm();
    sag = std::max(sag, length * half * half * half / 64); // R(1 − cos a)²/8, R = length/2a
  }
  return sag;
}

/// A facet at one of its edges, in the plane at a node.
struct Side {
  std::size_t facet;
  Vector3d normal; ///< there
  double extent;   ///< of the facet, away from the edge
  double bend;     ///< angle of its normals at the edge with that at its centre, twice
};

} // namespace

void setSags(const mesh::Surface& surface, std::vector<Facet>& facets) {
  std::map<std::array<GlobalOrdinal, 2>, std::vector<Side>> sides;
  std::vector<Vector3d> normals;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    Facet& facet = facets[f];
    std::vector<Point> points;
    for (Eigen::Index a = 0; a < facet.points.cols(); ++a)
      points.push_back({facet.points(0, a), facet.points(1, a), facet.points(2, a)});
    normals.resize(points.size());
    mesh::nodalNormals(facet.type, points, normals);
    const Vector3d middle = mesh::areaVector(facet.type, points);
    facet.sag = ownSag(facet, normals);
    const auto corners = surface.corners(f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const std::size_t next = corners.size() == 2 ? c : (c + 1) % corners.size();
      const Vector3d start = facet.points.col(index(c)), along = facet.points.col(index(next)) - start;
      double extent = 0;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vector3d off = facet.points.col(index(k)) - start;
        extent = std::max(extent, next == c ? off.norm() : off.cross(along.normalized()).norm());
      }
      const Vector3d normal = (normals[c] + normals[next]).normalized();
      const auto [least, most] = std::minmax(corners[c], corners[next]);
      sides[{least, most}].push_back({f, normal, extent, 2 * angleBetween(normal, middle)});
    }
  }
  for (const auto& [ends, at] : sides)
    for (const Side& a : at)
      for (const Side& b : at) {
        const double angle = angleBetween(a.normal, b.normal);
        constexpr double straight = 0.5; // more of the bend is between the facets than in them
        if (a.facet != b.facet && angle > straight * std::max(a.bend, b.bend))
          facets[a.facet].sag = std::max(facets[a.facet].sag, (a.extent + b.extent) / 2 * angle / 8);
      }
}

} // namespace epafi::assembly
