#include "epafi/contact/SymmetryPlanes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace epafi::contact {
namespace {

Eigen::Vector3d vectorOf(const Point& point) {
  return {point[0], point[1], point[2]};
}

/// A node of the second body that a place faces in the plane through its own node, across h, if supports hold
/// it along h.
std::optional<GlobalOrdinal> facingInPlane(const ContactLayout& contact, std::size_t place,
                                           const Eigen::Vector3d& h, const Eigen::Vector3d& point,
                                           const NodePoints& other, const HeldAxes& heldAxes) {
  constexpr double ofDistance = 1e-6, ofPlace = 1e-12; // round-off of points
  for (const NodeShare& share : contact.secondNodes[place]) {
    const Eigen::Vector3d apart = vectorOf(other(share.node)) - point;
    if (std::abs(apart.dot(h)) > ofDistance * apart.norm() + ofPlace * point.norm())
      continue;
    for (const Eigen::Vector3d& axis : heldAxes(contact.secondBody, share.node))
      if (std::abs(axis.dot(h)) > 1 - ofDistance)
        return share.node;
  }
  return std::nullopt;
}

} // namespace

void findSymmetryPlanes(const NodePoints& own, const NodePoints& other, const HeldAxes& heldAxes,
                        ContactLayout& contact) {
  constexpr double mostOff = 0.3;   // as elements of 35 degrees have; beyond it is a slope
  constexpr double leastFree = 0.5; // of d: less of it is a clamp's
  std::vector<std::vector<SymmetryPlane>> planes(contact.firstNodes.size());
  for (std::size_t place = 0; place < planes.size(); ++place) {
    const GlobalOrdinal node = contact.firstNodes[place];
    const Eigen::Vector3d normal = contact.directionAt(place), point = vectorOf(own(node));
    const std::vector<Eigen::Vector3d> axes = heldAxes(contact.firstBody, node);
    Eigen::Vector3d free = normal;
    for (const Eigen::Vector3d& axis : axes)
      free -= normal.dot(axis) * axis;
    for (const Eigen::Vector3d& axis : axes)
      if (free.norm() > leastFree && std::abs(normal.dot(axis)) <= mostOff)
        if (const auto facing = facingInPlane(contact, place, axis, point, other, heldAxes))
          planes[place].push_back({axis, *facing});
  }
  if (std::any_of(planes.begin(), planes.end(), [](const auto& each) { return !each.empty(); }))
    contact.symmetryPlanes = std::move(planes);
}

} // namespace epafi::contact
