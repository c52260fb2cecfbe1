#include "epafi/fem/SizeField.hpp"

#include "epafi/fem/ElementGeometry.hpp"

#include <Eigen/LU>
#define BOOST_ALLOW_DEPRECATED_HEADERS // what its own headers include
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace epafi::fem {
namespace geometry = boost::geometry;

struct SizeField::Boxes {
  using Corner = geometry::model::point<double, 3, geometry::cs::cartesian>;
  using Box = geometry::model::box<Corner>;
  using Entry = std::pair<Box, std::size_t>;
  geometry::index::rtree<Entry, geometry::index::quadratic<16>> tree;
};

SizeField::SizeField(MeshSizes sizes) : sizes_(std::move(sizes)) {
  std::vector<Boxes::Entry> entries;
  const auto count = static_cast<std::size_t>(sizes_.dimension) + 1;
  for (std::size_t first = 0; first < sizes_.corners.size(); first += count) {
    const auto [lower, upper] = boxOf(std::span(sizes_.corners).subspan(first, count));
    entries.emplace_back(Boxes::Box{{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}, first);
  }
  boxes_ = std::make_unique<const Boxes>(Boxes{decltype(Boxes::tree)(entries)});
}

SizeField::~SizeField() = default;

double SizeField::sizeIn(std::size_t simplex, const Point& point, double& outside) const {
  const int n = sizes_.dimension;
  const Point* corners = sizes_.corners.data() + simplex;
  Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (int d = 0; d < n; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    place[d] = point[axis] - corners[0][axis];
    for (int i = 0; i < n; ++i)
      edges(d, i) = corners[i + 1][axis] - corners[0][axis];
  }
  Eigen::Vector4d weights = Eigen::Vector4d::Zero();
  weights.segment<3>(1) = edges.partialPivLu().solve(place);
  weights[0] = 1 - weights.sum();
  outside = std::max(0.0, -weights.head(n + 1).minCoeff());
  constexpr double roundOff = 1e-9;
  outside = outside <= roundOff ? 0 : outside * edges.topLeftCorner(n, n).colwise().norm().maxCoeff();
  weights = weights.cwiseMax(0.0);
  weights /= weights.sum();
  double size = 0;
  for (int i = 0; i <= n; ++i)
    size += weights[i] * sizes_.sizes[simplex + static_cast<std::size_t>(i)];
  return size;
}

double SizeField::at(const Point& point) const {
  const Boxes::Corner place(point[0], point[1], point[2]);
  double least = std::numeric_limits<double>::infinity(), size = least;
  const auto look = [&](const auto& query) {
    for (auto entry = boxes_->tree.qbegin(query); entry != boxes_->tree.qend(); ++entry) {
      double outside = 0;
      const double here = sizeIn(entry->second, point, outside);
      if (outside < least || (outside == least && here < size)) {
        least = outside;
        size = here;
      }
    }
  };
  look(geometry::index::intersects(place));
  constexpr unsigned near = 8; // beyond the chords of a curved border
  if (!(least <= 0))
    look(geometry::index::nearest(place, near));
  return size;
}

} // namespace epafi::fem
