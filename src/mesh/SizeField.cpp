#include "epafi/mesh/SizeField.hpp"

#include "epafi/mesh/ElementGeometry.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace epafi::mesh {
namespace {

std::vector<BoxTree::Box> boxesOf(const MeshSizes& sizes) {
  std::vector<BoxTree::Box> boxes;
  const std::size_t count = sizes.dimension + 1;
  for (std::size_t first = 0; first < sizes.corners.size(); first += count)
    boxes.push_back(boxOf(std::span(sizes.corners).subspan(first, count)));
  return boxes;
}

} // namespace

SizeField::SizeField(MeshSizes sizes) : sizes_(std::move(sizes)), boxes_(boxesOf(sizes_)) {}

double SizeField::sizeIn(std::size_t simplex, const Point& point, double& outside) const {
  const int n = sizes_.dimension;
  const Point* corners = sizes_.corners.data() + simplex;
  Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (int d = 0; d < n; ++d) {
    const std::size_t axis = d;
    place[d] = point[axis] - corners[0][axis];
    for (int i = 0; i < n; ++i)
      edges(d, i) = corners[i + 1][axis] - corners[0][axis];
  }
  Eigen::Vector4d weights = Eigen::Vector4d::Zero();
  weights.segment<3>(1) = edges.inverse() * place;
  weights[0] = 1 - weights.sum();
  outside = std::max(0.0, -weights.head(n + 1).minCoeff());
  constexpr double roundOff = 1e-9;
  outside = outside <= roundOff ? 0 : outside * edges.topLeftCorner(n, n).colwise().norm().maxCoeff();
  weights = weights.cwiseMax(0.0);
  weights /= weights.sum();
  double size = 0;
  for (int i = 0; i <= n; ++i)
    size += weights[i] * sizes_.sizes[simplex + i];
  return size;
}

double SizeField::at(const Point& point) const {
  double least = std::numeric_limits<double>::infinity(), size = least;
  std::vector<std::size_t> found;
  const auto look = [&] {
    for (const std::size_t simplex : found) {
      double outside = 0;
      const double here = sizeIn(simplex * (sizes_.dimension + 1), point, outside);
      if (outside < least || (outside == least && here < size)) {
        least = outside;
        size = here;
      }
    }
  };
  boxes_.meeting({point, point}, found);
  look();
  constexpr std::size_t near = 8; // beyond the chords of a curved border
  if (!(least <= 0)) {
    boxes_.nearest(point, near, found);
    look();
  }
  return size;
}

} // namespace epafi::mesh
