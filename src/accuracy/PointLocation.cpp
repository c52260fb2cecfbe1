#include "epafi/accuracy/PointLocation.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/MeshPart.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace epafi::accuracy {
namespace {

using mesh::Mesh;

template <int dim>
double pullIn(const mesh::Shape<dim>& shape, mesh::Coordinates<dim>& xi);

/// Of a prism or pyramid: moves its height first, then the place at that height.
double pullIntoLevel(const mesh::Shape<3>& shape, mesh::Coordinates<3>& xi) {
  const bool isPyramid = numCornersOf(shape.type) == 5;
  const double height = std::clamp(xi[2], isPyramid ? 0.0 : -1.0, 1.0), width = isPyramid ? 1 - height : 1;
  double outside = std::abs(xi[2] - height);
  mesh::Coordinates<2> level = xi.head<2>();
  if (isPyramid) {
    level = level.cwiseMin(width).cwiseMax(-width).eval();
    outside = std::max(outside, (xi.head<2>() - level).cwiseAbs().maxCoeff());
  } else {
    outside = std::max(outside, pullIn(mesh::referenceShape<2>(mesh::CellType::triangle), level));
  }
  xi << level, height;
  return outside;
}

/// Moves reference coordinates into the reference element; returns how far they were outside.
template <int dim>
double pullIn(const mesh::Shape<dim>& shape, mesh::Coordinates<dim>& xi) {
  if constexpr (dim == 3)
    if (!shape.isSimplex && !shape.isBrick)
      return pullIntoLevel(shape, xi);
  if (!shape.isSimplex) {
    const double outside = std::max(0.0, xi.cwiseAbs().maxCoeff() - 1);
    xi = xi.cwiseMin(1.0).cwiseMax(-1.0);
    return outside;
  }
  const double outside = std::max({0.0, -xi.minCoeff(), xi.sum() - 1});
  xi = xi.cwiseMax(0.0);
  if (xi.sum() > 1)
    xi /= xi.sum();
  return outside;
}

/// Newton's method for x(ξ) = point, exact at once where the map is affine; not finite where it does not
/// settle, as far outside of curved elements.
template <int dim>
mesh::Coordinates<dim> coordinatesOf(const mesh::Shape<dim>& shape, std::span<const Point> corners,
                                     const Point& point) {
  const auto relative = mesh::relativeCorners<dim>(corners);
  mesh::Coordinates<dim> wanted, xi = shape.centre();
  for (int i = 0; i < dim; ++i) {
    const std::size_t axis = i;
    wanted[i] = point[axis] - corners[0][axis];
  }
  for (int iteration = 0; iteration < 20; ++iteration) {
    const auto sample = shape.sampleAt(xi);
    const mesh::ElementMap map(relative, sample);
    const mesh::Coordinates<dim> off = wanted - relative.lazyProduct(sample.values);
    const mesh::Coordinates<dim> step = map.jacobian().inverse() * off;
    xi += step.cwiseMin(2.0).cwiseMax(-2.0);
    if (!(step.norm() > 1e-12))
      return xi;
  }
  return mesh::Coordinates<dim>::Constant(std::numeric_limits<double>::quiet_NaN());
}

/// \param[out] outside  how far the point is outside of the element, in reference coordinates
Location locateIn(const Mesh& mesh, GlobalOrdinal element, const Point& point, double& outside) {
  std::vector<Point> corners;
  mesh.elementPoints(element, corners);
  Location location{element, {}};
  mesh::withShape(cellOf(mesh.cellType(), corners.size()), [&]<int dim>(const mesh::Shape<dim>& shape) {
    mesh::Coordinates<dim> xi = coordinatesOf(shape, corners, point);
    outside = xi.allFinite() ? pullIn(shape, xi) : std::numeric_limits<double>::infinity();
    const mesh::NodalValues values = shape.values(xi.allFinite() ? xi : shape.centre());
    std::copy(values.begin(), values.end(), location.weights.begin());
  });
  return location;
}

int cellOf(double x, double low, double size, int number) {
  return std::clamp(static_cast<int>(std::floor((x - low) / size)), 0, number - 1);
}

} // namespace

PointLocation::PointLocation(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.structured() != nullptr)
    return;
  std::vector<mesh::BoxTree::Box> boxes;
  std::vector<Point> nodes;
  const mesh::MeshPart* part = mesh.part();
  const GlobalOrdinal numHeld =
      part == nullptr ? mesh.numElements() : static_cast<GlobalOrdinal>(part->elements().size());
  for (GlobalOrdinal held = 0; held < numHeld; ++held) {
    const GlobalOrdinal element = part == nullptr ? held : part->elements()[held];
    mesh.elementPoints(element, nodes);
    auto [lower, upper] = mesh::boxOf(nodes);
    constexpr double margin = 0.01; // curved edges bulge beyond their nodes
    for (std::size_t d = 0; d < 3; ++d) {
      const double more = margin * (upper[d] - lower[d]);
      lower[d] -= more;
      upper[d] += more;
    }
    boxes.push_back({lower, upper});
  }
  boxes_.emplace(boxes);
}

/// The candidate that the point is least outside of.
Location PointLocation::best(const Point& point, const std::vector<std::size_t>& candidates,
                             double& outside) const {
  Location result;
  outside = std::numeric_limits<double>::infinity();
  const mesh::MeshPart* part = mesh_.part();
  for (const std::size_t held : candidates) {
    double here = 0;
    const Location location = locateIn(
        mesh_, part == nullptr ? static_cast<GlobalOrdinal>(held) : part->elements()[held], point, here);
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
  if (const mesh::StructuredMesh* grid = mesh_.structured()) {
    std::array<GlobalOrdinal, 3> cell{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(grid->dimension()); ++d)
      cell[d] = cellOf(point[d], grid->box().lower[d], grid->elementSize()[d], grid->elements()[d]);
    return locateIn(mesh_, cell[0] + grid->elements()[0] * (cell[1] + grid->elements()[1] * cell[2]), point,
                    outside);
  }
  std::vector<std::size_t> candidates;
  boxes_->meeting({point, point}, candidates);
  constexpr double roundOff = 1e-9;
  const Location location = best(point, candidates, outside);
  if (outside <= roundOff)
    return location;
  constexpr std::size_t near = 16; // beyond a curved border
  boxes_->nearest(point, near, candidates);
  return best(point, candidates, outside);
}

} // namespace epafi::accuracy
