#include "epafi/accuracy/PointLocation.hpp"

#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/MeshPart.hpp"
#include "epafi/fem/ShapeFunctions.hpp"
#include "epafi/fem/StructuredMesh.hpp"

#define BOOST_ALLOW_DEPRECATED_HEADERS // what its own headers include
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace epafi::accuracy {
namespace geometry = boost::geometry;
namespace {

using fem::Mesh;
using fem::Point;

/// Moves reference coordinates into the reference element; returns how far they were outside.
template <int dim, int order>
double pullIn(fem::Brick<dim, order> /*shape*/, Eigen::Matrix<double, dim, 1>& xi) {
  const double outside = std::max(0.0, xi.cwiseAbs().maxCoeff() - 1);
  xi = xi.cwiseMin(1.0).cwiseMax(-1.0);
  return outside;
}

template <int dim, int order>
double pullIn(fem::Simplex<dim, order> /*shape*/, Eigen::Matrix<double, dim, 1>& xi) {
  const double outside = std::max({0.0, -xi.minCoeff(), xi.sum() - 1});
  xi = xi.cwiseMax(0.0);
  if (xi.sum() > 1)
    xi /= xi.sum();
  return outside;
}

/// Newton's method for x(ξ) = point, exact at once where the map is affine; not finite where it does not settle, as far outside of
/// curved elements.
template <class Shape>
typename Shape::Coordinates coordinatesOf(std::span<const Point> corners, const Point& point) {
  constexpr int dim = Shape::dimension;
  const auto relative = fem::relativeCorners<Shape>(corners);
  typename Shape::Coordinates wanted, xi = Shape::centre();
  for (int i = 0; i < dim; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    wanted[i] = point[axis] - corners[0][axis];
  }
  for (int iteration = 0; iteration < 20; ++iteration) {
    const auto sample = fem::sampleAt<Shape>(xi);
    const fem::ElementMap<Shape> map(relative, sample);
    const typename Shape::Coordinates step =
        map.jacobian().partialPivLu().solve(wanted - relative * sample.values);
    xi += step.cwiseMin(2.0).cwiseMax(-2.0);
    if (!(step.norm() > 1e-12))
      return xi;
  }
  return Shape::Coordinates::Constant(std::numeric_limits<double>::quiet_NaN());
}

/// \param[out] outside  how far the point is outside of the element, in reference coordinates
Location locateIn(const Mesh& mesh, GlobalOrdinal element, const Point& point, double& outside) {
  std::vector<Point> corners;
  mesh.elementPoints(element, corners);
  Location location{element, {}};
  fem::withShape(mesh.cellType(), [&](auto shape) {
    using Shape = decltype(shape);
    typename Shape::Coordinates xi = coordinatesOf<Shape>(corners, point);
    outside = xi.allFinite() ? pullIn(shape, xi) : std::numeric_limits<double>::infinity();
    const typename Shape::Values values = Shape::values(xi.allFinite() ? xi : Shape::centre());
    std::copy(values.begin(), values.end(), location.weights.begin());
  });
  return location;
}

int cellOf(double x, double low, double size, int number) {
  return std::clamp(static_cast<int>(std::floor((x - low) / size)), 0, number - 1);
}

} // namespace

struct PointLocation::Boxes {
  using Corner = geometry::model::point<double, 3, geometry::cs::cartesian>;
  using Box = geometry::model::box<Corner>;
  using Entry = std::pair<Box, GlobalOrdinal>;
  geometry::index::rtree<Entry, geometry::index::quadratic<16>> tree;
};

PointLocation::PointLocation(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.structured() != nullptr)
    return;
  std::vector<Boxes::Entry> entries;
  std::vector<Point> nodes;
  const fem::MeshPart* part = mesh.part();
  const GlobalOrdinal numHeld =
      part == nullptr ? mesh.numElements() : static_cast<GlobalOrdinal>(part->elements().size());
  for (GlobalOrdinal held = 0; held < numHeld; ++held) {
    const GlobalOrdinal element = part == nullptr ? held : part->elements()[static_cast<std::size_t>(held)];
    mesh.elementPoints(element, nodes);
    auto [lower, upper] = fem::boxOf(nodes);
    constexpr double margin = 0.01; // curved edges bulge beyond their nodes
    for (std::size_t d = 0; d < 3; ++d) {
      const double more = margin * (upper[d] - lower[d]);
      lower[d] -= more;
      upper[d] += more;
    }
    entries.emplace_back(Boxes::Box{{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}, element);
  }
  boxes_ = std::make_unique<const Boxes>(Boxes{decltype(Boxes::tree)(entries)});
}

PointLocation::~PointLocation() = default;

/// The candidate that the point is least outside of.
Location PointLocation::best(const Point& point, const std::vector<GlobalOrdinal>& candidates,
                             double& outside) const {
  Location result;
  outside = std::numeric_limits<double>::infinity();
  for (const GlobalOrdinal element : candidates) {
    double here = 0;
    const Location location = locateIn(mesh_, element, point, here);
    if (here < outside) {
      outside = here;
      result = location;
    }
    if (outside == 0)
      break;
  }
  return result;
}

Location PointLocation::find(const Point& point) const {
  double outside = 0;
  if (const fem::StructuredMesh* grid = mesh_.structured()) {
    std::array<GlobalOrdinal, 3> cell{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(grid->dimension()); ++d)
      cell[d] = cellOf(point[d], grid->box().lower[d], grid->elementSize()[d], grid->elements()[d]);
    return locateIn(mesh_, cell[0] + grid->elements()[0] * (cell[1] + grid->elements()[1] * cell[2]), point,
                    outside);
  }
  const Boxes::Corner place(point[0], point[1], point[2]);
  std::vector<GlobalOrdinal> candidates;
  const auto collect = [&](const auto& query) {
    candidates.clear();
    for (auto entry = boxes_->tree.qbegin(query); entry != boxes_->tree.qend(); ++entry)
      candidates.push_back(entry->second);
    return best(point, candidates, outside);
  };
  constexpr double roundOff = 1e-9;
  const Location location = collect(geometry::index::intersects(place));
  if (outside <= roundOff)
    return location;
  constexpr unsigned near = 16; // beyond a curved border
  return collect(geometry::index::nearest(place, near));
}

} // namespace epafi::accuracy
