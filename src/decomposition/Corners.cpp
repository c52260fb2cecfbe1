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

Eigen::Vector3d toVector(const fem::Point& point) {
  return {point[0], point[1], point[2]};
}

std::vector<char> findCornersInPlane(const BodyOutline& body, const Piece& piece) {
  std::vector<char> isCorner(piece.sharing.size(), 0);
  for (std::size_t k = 0; k < isCorner.size(); ++k) {
    const std::size_t copies = piece.sharing.parts(k).size();
    if (copies >= 3 || (copies == 2 && body.isBoundaryNode(piece.assembled.nodes[piece.sharing.node(k)])))
      isCorner[k] = 1;
  }
  return isCorner;
}

std::vector<char> findCornersInSpace(const BodyOutline& body, const Piece& piece) {
  std::map<std::vector<int>, int> numNodesOf; // shared by just these parts
  for (std::size_t k = 0; k < piece.sharing.size(); ++k)
    if (const std::span<const int> parts = piece.sharing.parts(k); parts.size() >= 3)
      ++numNodesOf[{parts.begin(), parts.end()}];
  std::vector<char> isCorner(piece.sharing.size(), 0);
  for (std::size_t k = 0; k < isCorner.size(); ++k)
    if (const std::span<const int> parts = piece.sharing.parts(k); parts.size() >= 3)
      isCorner[k] = numNodesOf[{parts.begin(), parts.end()}] == 1 ||
                            body.isBoundaryNode(piece.assembled.nodes[piece.sharing.node(k)])
                        ? 1
                        : 0;
  return isCorner;
}

} // namespace

std::vector<char> findCorners(const BodyOutline& body, const Piece& piece) {
  return body.dimension == 2 ? findCornersInPlane(body, piece) : findCornersInSpace(body, piece);
}

/// How much farther from the others a point lies than one that adds nothing; 0 if it adds nothing.
double HoldingPoints::gain(const fem::Point& point) const {
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

void HoldingPoints::add(const fem::Point& point) {
  if (!hold() && gain(point) > 0)
    points_.push_back(point);
}

std::vector<std::size_t> HoldingPoints::complete(const std::vector<fem::Point>& candidates) {
  std::vector<std::size_t> places;
  if (hold() || candidates.empty())
    return places;
  Eigen::Vector3d centre(0, 0, 0);
  for (const fem::Point& point : candidates)
    centre += toVector(point) / static_cast<double>(candidates.size());
  while (!hold()) {
    // The first point of a scalar field lies in the middle, that of a body at its end; the others far from those before.
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
