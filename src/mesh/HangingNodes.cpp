#include "epafi/mesh/HangingNodes.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <limits>

namespace epafi::mesh {
namespace {

using Vector3 = Eigen::Vector3d;

constexpr double facetTolerance = 1e-6;     ///< of the facet's diameter
constexpr double neighbourTolerance = 1e-2; ///< of the distance to the nearest neighbour

Vector3 vectorOf(const Point& point) {
  return {point[0], point[1], point[2]};
}

/// Coordinates moved to where the reference facet is.
template <int dim>
Coordinates<dim> clamped(const Shape<dim>& shape, Coordinates<dim> xi) {
  if (!shape.isSimplex)
    return xi.cwiseMax(-1).cwiseMin(1);
  if (xi.sum() > 1)
    xi.array() -= (xi.sum() - 1) / dim;
  return xi.cwiseMax(0).cwiseMin(1);
}

/// Distance from a node to the nearest of those that share an element with it.
double distanceToNeighbours(LocalOrdinal node, const MeshArrays& mesh, const MeshTopology& topology) {
  double nearest = std::numeric_limits<double>::infinity();
  const Vector3 own = vectorOf(mesh.points[node]);
  for (const LocalOrdinal element : topology.elementsOf(node))
    for (const LocalOrdinal other : nodesOf(mesh.cellType, mesh.cells, element))
      if (other != node)
        nearest = std::min(nearest, (vectorOf(mesh.points[other]) - own).norm());
  return nearest;
}

} // namespace

double distanceFrom(CellType type, std::span<const Point> facet, const Point& point) {
  return withFacetShape(type, [&]<int dim>(const Shape<dim>& shape) {
    constexpr int mostSteps = 20; // a plane facet takes one or two
    const auto corners = relativeCorners<3>(facet);
    const Vector3 wanted = vectorOf(point) - vectorOf(facet[0]);
    Coordinates<dim> xi = shape.centre();
    for (int step = 0; step < mostSteps; ++step) { // Gauss–Newton for the nearest point
      const ShapeSample<dim> sample = shape.sampleAt(xi);
      const Vector3 off = wanted - corners * sample.values;
      const Eigen::Matrix<double, 3, dim> tangents = derivatives(corners, sample);
      const Coordinates<dim> change =
          (tangents.transpose() * tangents).inverse() * (tangents.transpose() * off);
      xi += change;
      if (change.norm() <= 1e-12)
        break;
    }
    const Vector3 nearest = corners * shape.values(clamped(shape, xi));
    return (wanted - nearest).norm();
  });
}

std::optional<HangingNode> findHangingNode(const MeshArrays& mesh, const MeshTopology& topology,
                                           const BoxTree& tree) {
  std::vector<Point> corners;
  std::vector<std::size_t> found;
  for (LocalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const auto nodes = nodesOf(mesh.cellType, mesh.cells, element);
    const auto facets = facetsOf(cellOf(mesh.cellType, nodes.size()));
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (topology.across(element, f) >= 0)
        continue;
      corners.clear();
      for (const int place : facets[f])
        corners.push_back(mesh.points[nodes[place]]);
      const double tolerance = facetTolerance * diameterOf(corners);
      tree.meeting(boxOf(corners, tolerance), found);
      for (const std::size_t place : found) {
        const auto node = static_cast<LocalOrdinal>(place);
        if (!topology.isOnBoundary(node) || std::find(nodes.begin(), nodes.end(), node) != nodes.end())
          continue; // inner nodes touch no unmatched facet
        const double distance = distanceFrom(facets[f].type, corners, mesh.points[node]);
        if (distance <= tolerance &&
            distance <= neighbourTolerance * distanceToNeighbours(node, mesh, topology))
          return HangingNode{node, element};
      }
    }
  }
  return std::nullopt;
}

} // namespace epafi::mesh
