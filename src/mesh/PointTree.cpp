#include "epafi/mesh/PointTree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace epafi::mesh {
namespace {

constexpr std::size_t shortRange = 8;

std::size_t middleOf(std::size_t begin, std::size_t end) {
  return begin + (end - begin) / 2;
}

} // namespace

PointTree::PointTree(std::span<const Point> points)
    : index_(points.size()), points_(points.begin(), points.end()), axis_(points.size(), 0) {
  std::iota(index_.begin(), index_.end(), 0);
  sort(0, points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    points_[i] = points[index_[i]];
}

void PointTree::sort(std::size_t begin, std::size_t end) {
  if (end - begin <= shortRange)
    return;
  const auto pointOf = [&](std::size_t i) -> const Point& {
    return points_[index_[i]]; // not in the order of index_ yet
  };
  Point lower = pointOf(begin), upper = lower;
  for (std::size_t i = begin + 1; i < end; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], pointOf(i)[axis]);
      upper[axis] = std::max(upper[axis], pointOf(i)[axis]);
    }
  std::size_t widest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (upper[axis] - lower[axis] > upper[widest] - lower[widest])
      widest = axis;
  const std::size_t middle = middleOf(begin, end);
  const auto at = [&](std::size_t i) { return index_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [&](LocalOrdinal a, LocalOrdinal b) { return points_[a][widest] < points_[b][widest]; });
  axis_[middle] = static_cast<std::uint8_t>(widest);
  sort(begin, middle);
  sort(middle + 1, end);
}

void PointTree::inBox(const Point& lower, const Point& upper, std::vector<LocalOrdinal>& found) const {
  found.clear();
  const auto isInside = [&](const Point& point) {
    return point[0] >= lower[0] && point[0] <= upper[0] && point[1] >= lower[1] && point[1] <= upper[1] &&
           point[2] >= lower[2] && point[2] <= upper[2];
  };
  const auto visit = [&](const auto& self, std::size_t begin, std::size_t end) -> void {
    if (end - begin <= shortRange) {
      for (std::size_t i = begin; i < end; ++i)
        if (isInside(points_[i]))
          found.push_back(index_[i]);
      return;
    }
    const std::size_t middle = middleOf(begin, end);
    if (isInside(points_[middle]))
      found.push_back(index_[middle]);
    const std::size_t axis = axis_[middle];
    if (lower[axis] <= points_[middle][axis])
      self(self, begin, middle);
    if (upper[axis] >= points_[middle][axis])
      self(self, middle + 1, end);
  };
  visit(visit, 0, points_.size());
}

LocalOrdinal PointTree::nearest(const Point& x) const {
  LocalOrdinal best = -1;
  double least = std::numeric_limits<double>::infinity(); // squared distance
  const auto look = [&](std::size_t i) {
    const Point& point = points_[i];
    const double a = point[0] - x[0], b = point[1] - x[1], c = point[2] - x[2],
                 squared = a * a + b * b + c * c;
    if (squared < least || (squared == least && index_[i] < best)) {
      least = squared;
      best = index_[i];
    }
  };
  const auto visit = [&](const auto& self, std::size_t begin, std::size_t end) -> void {
    if (end - begin <= shortRange) {
      for (std::size_t i = begin; i < end; ++i)
        look(i);
      return;
    }
    const std::size_t middle = middleOf(begin, end), axis = axis_[middle];
    look(middle);
    const double beyond = x[axis] - points_[middle][axis]; // first the side that x lies on
    const auto lower = [&] { self(self, begin, middle); };
    const auto upper = [&] { self(self, middle + 1, end); };
    beyond < 0 ? lower() : upper();
    if (beyond * beyond <= least)
      beyond < 0 ? upper() : lower();
  };
  visit(visit, 0, points_.size());
  return best;
}

} // namespace epafi::mesh
