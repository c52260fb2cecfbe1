#include "epafi/fem/HangingNodes.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <limits>

namespace epafi::fem {
namespace {

using Vector3 = Eigen::Vector3d;

constexpr double facetTolerance = 1e-6;     ///< of the facet's diameter
constexpr double neighbourTolerance = 1e-2; ///< of the distance to the nearest neighbour

Vector3 vectorOf(const Point& point) {
  return {point[0], point[1], point[2]};
}

double diameterOf(std::span<const Point> facet) {
  double diameter = 0;
  for (const Point& a : facet)
    for (const Point& b : facet)
      diameter = std::max(diameter, (vectorOf(a) - vectorOf(b)).norm());
  return diameter;
}

/// A facet as an image x(s, t) of [0,1], of the triangle s, t ≥ 0, s + t ≤ 1, or of [0,1]².
struct Patch {
  std::span<const Point> facet;

  [[nodiscard]] Vector3 at(double s, double t) const {
    const Vector3 a = vectorOf(facet[0]), b = vectorOf(facet[1]);
    if (facet.size() == 2)
      return (1 - s) * a + s * b;
    if (facet.size() == 3)
      return (1 - s - t) * a + s * b + t * vectorOf(facet[2]);
    return (1 - t) * ((1 - s) * a + s * b) + t * (s * vectorOf(facet[2]) + (1 - s) * vectorOf(facet[3]));
  }
  /// ∂x/∂s and ∂x/∂t; of an edge the second is 0. Differences are exact: x is linear in each parameter.
  [[nodiscard]] Eigen::Matrix<double, 3, 2> derivatives(double s, double t) const {
    Eigen::Matrix<double, 3, 2> columns;
    columns.col(0) = at(1, t) - at(0, t);
    columns.col(1) = at(s, 1) - at(s, 0);
    return columns;
  }
};

/// Parameters moved to where the facet is.
Eigen::Vector2d clamped(Eigen::Vector2d parameters, std::size_t corners) {
  if (corners == 3 && parameters.sum() > 1)
    parameters.array() -= (parameters.sum() - 1) / 2;
  return parameters.cwiseMax(0).cwiseMin(1);
}

/// Distance from a node to the nearest of those that share an element with it.
double distanceToNeighbours(LocalOrdinal node, const MeshArrays& mesh, const MeshTopology& topology) {
  double nearest = std::numeric_limits<double>::infinity();
  const Vector3 own = vectorOf(mesh.points[static_cast<std::size_t>(node)]);
  for (const LocalOrdinal element : topology.elementsOf(node))
    for (const LocalOrdinal other : nodesOf(mesh.cellType, mesh.cells, element))
      if (other != node)
        nearest = std::min(nearest, (vectorOf(mesh.points[static_cast<std::size_t>(other)]) - own).norm());
  return nearest;
}

/// The corners' box, widened.
std::array<Point, 2> boxOf(std::span<const Point> corners, double margin) {
  Point lower = corners[0], upper = corners[0];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Point& corner : corners) {
      lower[axis] = std::min(lower[axis], corner[axis]);
      upper[axis] = std::max(upper[axis], corner[axis]);
    }
    lower[axis] -= margin;
    upper[axis] += margin;
  }
  return {lower, upper};
}

} // namespace

double distanceFrom(std::span<const Point> facet, const Point& point) {
  constexpr int mostSteps = 20; // a plane facet takes one or two
  const Patch patch{facet};
  const Vector3 wanted = vectorOf(point);
  Eigen::Vector2d parameters(0.5, facet.size() == 2 ? 0.0 : 0.5);
  for (int step = 0; step < mostSteps; ++step) { // Gauss–Newton for the nearest point
    const Vector3 residual = wanted - patch.at(parameters[0], parameters[1]);
    const auto derivatives = patch.derivatives(parameters[0], parameters[1]);
    Eigen::Vector2d change = Eigen::Vector2d::Zero();
    if (facet.size() == 2)
      change[0] = derivatives.col(0).dot(residual) / derivatives.col(0).squaredNorm();
    else
      change = derivatives.colPivHouseholderQr().solve(residual);
    parameters += change;
    if (change.norm() <= 1e-12)
      break;
  }
  parameters = clamped(parameters, facet.size());
  return (wanted - patch.at(parameters[0], parameters[1])).norm();
}

std::optional<HangingNode> findHangingNode(const MeshArrays& mesh, const MeshTopology& topology,
                                           const PointTree& tree) {
  const auto facets = facetsOf(mesh.cellType);
  const auto perFacet = static_cast<std::size_t>(nodesPerFacet(mesh.cellType));
  std::array<Point, 4> storage{};
  const std::span<const Point> corners(storage.data(), perFacet);
  std::vector<LocalOrdinal> found;
  for (LocalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const auto nodes = nodesOf(mesh.cellType, mesh.cells, element);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (topology.across(element, f) >= 0)
        continue;
      for (std::size_t i = 0; i < perFacet; ++i)
        storage[i] = mesh.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(facets[f][i])])];
      const double tolerance = facetTolerance * diameterOf(corners);
      const auto [lower, upper] = boxOf(corners, tolerance);
      tree.inBox(lower, upper, found);
      std::sort(found.begin(), found.end());
      for (const LocalOrdinal node : found) {
        if (!topology.isOnBoundary(node) || std::find(nodes.begin(), nodes.end(), node) != nodes.end())
          continue; // inner nodes touch no unmatched facet
        const double distance = distanceFrom(corners, mesh.points[static_cast<std::size_t>(node)]);
        if (distance <= tolerance &&
            distance <= neighbourTolerance * distanceToNeighbours(node, mesh, topology))
          return HangingNode{node, element};
      }
    }
  }
  return std::nullopt;
}

} // namespace epafi::fem
