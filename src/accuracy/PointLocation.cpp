#include "epafi/accuracy/PointLocation.hpp"

#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/ShapeFunctions.hpp"
#include "epafi/fem/StructuredMesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace epafi::accuracy {
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

PointLocation::PointLocation(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.structured() != nullptr)
    return;
  std::vector<Point> centres, corners;
  centres.reserve(static_cast<std::size_t>(mesh.numElements()));
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    mesh.elementPoints(element, corners);
    centres.push_back(fem::centreOf(corners));
  }
  const auto [lower, upper] = fem::boxOf(centres);
  centres_ = std::make_unique<fem::PointTree>(centres);
  for (std::size_t d = 0; d < 3; ++d)
    extent_ = std::max(extent_, upper[d] - lower[d]);
  reach_ = extent_ / std::pow(static_cast<double>(mesh.numElements()), 1.0 / dimensionOf(mesh.cellType()));
  if (!(reach_ > 0)) // a single element
    reach_ = extent_ = 1;
}

/// The candidate that the point is least outside of.
Location PointLocation::best(const Point& point, std::span<const LocalOrdinal> candidates,
                             double& outside) const {
  Location result;
  outside = std::numeric_limits<double>::infinity();
  for (const LocalOrdinal element : candidates) {
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

Location PointLocation::find(const Point& point) {
  double outside = 0;
  if (const fem::StructuredMesh* grid = mesh_.structured()) {
    std::array<GlobalOrdinal, 3> cell{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(grid->dimension()); ++d)
      cell[d] = cellOf(point[d], grid->box().lower[d], grid->elementSize()[d], grid->elements()[d]);
    return locateIn(mesh_, cell[0] + grid->elements()[0] * (cell[1] + grid->elements()[1] * cell[2]), point,
                    outside);
  }
  // The element that a point lies in may be much larger than most, its centre far away: one that the point is clearly outside of
  // does for points beyond a curved border alone, after a look further off.
  constexpr double roundOff = 1e-9, near = 0.1;
  for (double reach = reach_;; reach *= 2) {
    const auto [lower, upper] = fem::boxOf(std::span(&point, 1), reach);
    centres_->inBox(lower, upper, found_);
    if (found_.empty())
      continue;
    const Location location = best(point, found_, outside);
    if (outside <= roundOff || (outside <= near && reach > 4 * reach_) || reach > 2 * extent_)
      return location;
  }
}

} // namespace epafi::accuracy
