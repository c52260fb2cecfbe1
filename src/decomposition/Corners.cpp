#include "epafi/decomposition/Corners.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

namespace epafi::decomposition {
namespace {

/// Points nearer to a line, beside those that span it, than this are on it.
constexpr double onLine = 1e-3;

Eigen::Vector3d toVector(const Point& point) {
  return {point[0], point[1], point[2]};
}

bool isOnBoundary(const Substructures& all, std::size_t subdomain, std::size_t place) {
  const Subdomain& at = all.subdomains[subdomain];
  return all.places.isBoundaryNode && all.places.isBoundaryNode(at.body, at.nodes[place]);
}

} // namespace

std::vector<char> findCorners(const Substructures& all, const SharedNodes& shared, std::size_t subdomain) {
  const std::span<const SharedNodes::Copy> copies = shared.copiesOf(subdomain);
  const bool isPlane = all.places.dimension == 2;
  std::map<std::vector<int>, int> numNodesOf; // in space: shared by just these subdomains
  const auto key = [&](const SharedNodes::Copy& copy) {
    const std::span<const int> at = shared.subdomainsAt(copy.node);
    return std::vector<int>(at.begin(), at.end());
  };
  if (!isPlane)
    for (const SharedNodes::Copy& copy : copies)
      if (shared.subdomainsAt(copy.node).size() >= 3)
        ++numNodesOf[key(copy)];
  std::vector<char> isCorner(copies.size(), 0);
  for (std::size_t k = 0; k < copies.size(); ++k) {
    const bool meet = shared.subdomainsAt(copies[k].node).size() >= 3;
    const bool decides = isPlane ? meet : meet && numNodesOf[key(copies[k])] == 1;
    isCorner[k] = decides || ((isPlane || meet) && isOnBoundary(all, subdomain, copies[k].place)) ? 1 : 0;
  }
  return isCorner;
}

/// How much farther from the others a point lies than one that adds nothing; 0 if it adds nothing.
double HoldingPoints::gain(const Point& point) const {
  const Eigen::Vector3d x = toVector(point);
  switch (points_.size()) {
  case 0:
    return 1;
  case 1:
    return (x - toVector(points_[0])).norm();
  case 2: {
    const Eigen::Vector3d along = toVector(points_[1]) - toVector(points_[0]);
    const double distance = along.normalized().cross(x - toVector(points_[0])).norm();
    return distance > onLine * along.norm() ? distance : 0;
  }
  default:
    return 0;
  }
}

void HoldingPoints::add(const Point& point) {
  if (!hold() && gain(point) > 0)
    points_.push_back(point);
}

std::vector<std::size_t> HoldingPoints::complete(const std::vector<Point>& candidates) {
  std::vector<std::size_t> places;
  if (hold() || candidates.empty())
    return places;
  Eigen::Vector3d centre(0, 0, 0);
  for (const Point& point : candidates)
    centre += toVector(point) / static_cast<double>(candidates.size());
  while (!hold()) {
    // The first point of a scalar field lies in the middle, that of a body at its end; the others far from
    // those before.
    double best = 0;
    std::size_t place = candidates.size();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double distance = (toVector(candidates[i]) - centre).norm();
      const double worth = !points_.empty() ? gain(candidates[i])
                           : needed_ == 1   ? 1 / (1e-300 + distance)
                                            : distance;
      if (worth > best * (1 + 1e-12)) {
        best = worth;
        place = i;
      }
    }
    if (place == candidates.size())
      break; // no candidate adds anything
    points_.push_back(candidates[place]);
    places.push_back(place);
  }
  return places;
}

} // namespace epafi::decomposition
