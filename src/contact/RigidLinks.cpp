#include "epafi/contact/RigidLinks.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

namespace epafi::contact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Levers shorter than this share of the extent of the nodes around are what facets deviate from a curve.
constexpr double shortest = 1e-4;
/// Moments of inertia below this share of the largest one are those of a line about itself.
constexpr double slender = 1e-6;

/// Some nodes, seen from their centre.
struct Patch {
  std::vector<GlobalOrdinal> nodes;
  std::vector<Vector3d> places;
  double size = 0; ///< root of Σ|y|²
  Eigen::SelfAdjointEigenSolver<Matrix3d> inertia;
};

class Links {
public:
  Links(const PlacedSurface& first, const PlacedSurface& second) : first_(first), second_(second) {
    for (std::size_t f = 0; f < second.surface.numFacets(); ++f)
      for (const GlobalOrdinal node : second.surface.facet(f))
        facetsAt_[node].push_back(f);
  }

  /// e of a row; empty if it has no couple.
  [[nodiscard]] std::vector<NodeForce> levers(const ContactLayout& tie, std::size_t row) const {
    const Vector3d origin = placeOf(first_, tie.firstNodes[row]), direction = tie.directionAt(row);
    Vector3d apart(0, 0, 0);
    tie.forEachFirst(
        row, [&](const NodeShare& share) { apart += share.weight * (placeOf(first_, share.node) - origin); });
    std::set<GlobalOrdinal> nodes;
    for (const NodeShare& share : tie.secondNodes[row]) {
      apart -= share.weight * (placeOf(second_, share.node) - origin);
      nodes.insert(share.node);
    }
    const Vector3d couple = apart.cross(direction);
    Patch patch = patchOf(nodes, origin);
    if (!canCarry(patch, couple))
      patch = patchOf(withNeighbours(nodes), origin);
    std::vector<NodeForce> result;
    if (couple.norm() <= shortest * patch.size || !canCarry(patch, couple))
      return result;
    Vector3d turn(0, 0, 0);
    for (int axis = 0; axis < 3; ++axis)
      if (const double inertia = patch.inertia.eigenvalues()[axis];
          inertia > slender * patch.inertia.eigenvalues()[2]) {
        const Vector3d along = patch.inertia.eigenvectors().col(axis);
        turn += along.dot(couple) / inertia * along;
      }
    for (std::size_t l = 0; l < patch.nodes.size(); ++l)
      result.push_back({patch.nodes[l], turn.cross(patch.places[l])});
    return result;
  }

private:
  static Vector3d placeOf(const PlacedSurface& surface, GlobalOrdinal node) {
    const Point x = surface.pointAt(node);
    return {x[0], x[1], x[2]};
  }

  [[nodiscard]] std::set<GlobalOrdinal> withNeighbours(const std::set<GlobalOrdinal>& nodes) const {
    std::set<GlobalOrdinal> all = nodes;
    for (const GlobalOrdinal node : nodes)
      for (const std::size_t f : facetsAt_.at(node))
        all.insert(second_.surface.facet(f).begin(), second_.surface.facet(f).end());
    return all;
  }

  [[nodiscard]] Patch patchOf(const std::set<GlobalOrdinal>& nodes, const Vector3d& origin) const {
    Patch patch;
    Vector3d centre(0, 0, 0);
    for (const GlobalOrdinal node : nodes) {
      patch.nodes.push_back(node);
      patch.places.emplace_back(placeOf(second_, node) - origin);
      centre += patch.places.back() / static_cast<double>(nodes.size());
    }
    Matrix3d inertia = Matrix3d::Zero();
    for (Vector3d& y : patch.places) {
      y -= centre;
      inertia += y.squaredNorm() * Matrix3d::Identity() - y * y.transpose();
    }
    patch.size = std::sqrt(inertia.trace() / 2);
    patch.inertia.compute(inertia);
    return patch;
  }

  /// Whether the couple is about axes about which the nodes do not lie on a line.
  static bool canCarry(const Patch& patch, const Vector3d& couple) {
    const Vector3d inertia = patch.inertia.eigenvalues();
    if (!(inertia[2] > 0))
      return false;
    for (int axis = 0; axis < 3; ++axis)
      if (inertia[axis] <= slender * inertia[2] &&
          std::abs(patch.inertia.eigenvectors().col(axis).dot(couple)) > slender * couple.norm())
        return false;
    return true;
  }

  const PlacedSurface &first_, &second_;
  std::map<GlobalOrdinal, std::vector<std::size_t>> facetsAt_;
};

} // namespace

void linkRigidly(const PlacedSurface& first, const PlacedSurface& second, ContactLayout& tie) {
  if (tie.directions.size() == tie.firstNodes.size())
    return; // a deflection has no lever
  const Links links(first, second);
  bool isAny = false;
  for (std::size_t row = 0; row < tie.firstNodes.size(); ++row) {
    tie.secondLevers.push_back(links.levers(tie, row));
    isAny = isAny || !tie.secondLevers.back().empty();
  }
  if (!isAny)
    tie.secondLevers.clear();
}

} // namespace epafi::contact
