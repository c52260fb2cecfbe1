#pragma once

/// Where bodies may touch, before any of it is a matrix row.

#include "epafi/base/Types.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <string>
#include <vector>

namespace epafi::contact {

/// A node, and how much of it counts.
struct NodeShare {
  GlobalOrdinal node;
  double weight;
};

/// What a node is moved by in a row: a force on it.
struct NodeForce {
  GlobalOrdinal node;
  Eigen::Vector3d force;
};

/// A plane of symmetry that a node with a row lies in: supports hold the node across it.
struct SymmetryPlane {
  Eigen::Vector3d normal; ///< of length 1
  GlobalOrdinal facing;   ///< a node of the second body that they hold likewise, in the same plane
};

/// A contact: one inequality, a *row*, for each of some nodes of the first body's surface,
///   dᵀ(u_first − u_second) ≤ gap,
/// d the direction in which the second body, or an obstacle, lies (1 for membranes), u_first and u_second
/// values at nodes or means of some. Of a tied joint = takes the place of ≤, and a node has a row for each
/// component. It is whole on every rank: of the size of the surfaces that may touch.
///
/// Contacts between the same bodies whose surfaces go on in each other share rows, as if their surfaces were
/// one: each has a layout with all of these, and `portions` say what of a row's force and area is its own.
struct ContactLayout {
  std::string name;
  int number = 0;             ///< of the contact, as the caller counts
  std::string means;          ///< how its sides are coupled, in some words
  GlobalOrdinal firstRow = 0; ///< multiplier index of its first row
  /// Number of its first row's node among those with friction; −1: it has none.
  GlobalOrdinal firstFriction = -1;
  int firstBody = 0;        ///< the one whose nodes have the rows
  std::string firstSurface; ///< the surface of it
  /// All whose nodes have the rows, `firstSurface` among them, and those of the second body that they face.
  std::vector<std::string> firstSurfaces, secondSurfaces;
  std::vector<double> portions; ///< of each row, from 0 to 1, by area; empty: all of all
  bool hasOwnRows = true;       ///< false: its rows are those of a contact before it
  std::string note;             ///< what a user should know of it; perhaps empty
  int secondBody = -1;          ///< −1: an obstacle, which does not move
  std::vector<GlobalOrdinal> firstNodes;
  /// What moves a row on the first surface: by mortars nodes around; empty: its own node alone.
  std::vector<std::vector<NodeShare>> firstShares;
  std::vector<std::vector<NodeShare>>
      secondNodes;                ///< what the same rows face, one node or more; empty for an obstacle
  std::vector<double> directions; ///< d, `components` numbers a row
  /// Those in which the node of a row lies (SymmetryPlanes.hpp); empty: none does.
  std::vector<std::vector<SymmetryPlane>> symmetryPlanes;
  std::vector<double> gaps; ///< before supports are taken into account
  /// Share of the first surface on which a row's force acts; in the plane of its length, times the thickness
  /// of the thinner body or, of solids of revolution, 2πr.
  std::vector<double> areas;
  /// Of areas what each of the united contacts has; empty: there is one alone.
  std::vector<std::vector<double>> areasOfParts;
  /// What a row takes of the second body beside `secondNodes`, to be subtracted like these: forces that add
  /// up to none, and balance the moment of the others (RigidLinks.hpp). Empty: nothing.
  std::vector<std::vector<NodeForce>> secondLevers;
  GlobalOrdinal numBent = 0; ///< rows where a surface bends sharply, and has a mean normal
  /// Places of rows, with weights.
  struct Share {
    std::size_t node;
    double weight;
  };
  /// Of order 2, for each row k, W_kb: N̂_k = Σ W_kb N_b, the functions with which pressures and gaps are
  /// looked at (QuadraticFaces.hpp); empty of order 1, whose own functions serve.
  std::vector<std::vector<Share>> smoothed;
  /// Rows that are combinations of those of several nodes, Σ weight · (dᵀ(u_first − u_second) ≤ gap)_node:
  /// dual to N̂; empty: each row is that of its own node.
  std::vector<std::vector<Share>> combinations;
  /// Whether rows are dual to N̂, and so their gaps are coefficients of N̂ instead of values at nodes.
  bool isDual = false;

  /// Components of a direction: unknowns a node.
  [[nodiscard]] std::size_t numComponents() const {
    return directions.size() / std::max<std::size_t>(1, firstNodes.size());
  }
  /// d of a node with a row, the components beyond numComponents() being 0.
  [[nodiscard]] Eigen::Vector3d directionAt(std::size_t place) const {
    Eigen::Vector3d direction(0, 0, 0);
    for (std::size_t c = 0; c < numComponents(); ++c)
      direction[c] = directions[place * numComponents() + c];
    return direction;
  }
  /// The same in space, where the deflection of membranes is along z.
  [[nodiscard]] Eigen::Vector3d spatialDirectionAt(std::size_t place) const {
    return numComponents() == 1 ? Eigen::Vector3d(0, 0, directions[place]) : directionAt(place);
  }
  /// d less what of it leaves planes of symmetry, of length 1: what tangents at a node are perpendicular to.
  [[nodiscard]] Eigen::Vector3d slidingNormalAt(std::size_t place) const {
    Eigen::Vector3d normal = directionAt(place);
    if (symmetryPlanes.empty() || symmetryPlanes[place].empty())
      return normal;
    for (const SymmetryPlane& plane : symmetryPlanes[place])
      normal -= normal.dot(plane.normal) * plane.normal;
    return normal.normalized();
  }
  /// Direction in space of a row, of those of its nodes as they are combined.
  [[nodiscard]] Eigen::Vector3d spatialDirectionOf(std::size_t row) const {
    Eigen::Vector3d direction(0, 0, 0);
    forEachShare(row,
                 [&](std::size_t place, double weight) { direction += weight * spatialDirectionAt(place); });
    return direction;
  }
  /// Number of inequalities.
  [[nodiscard]] GlobalOrdinal numRows() const { return static_cast<GlobalOrdinal>(firstNodes.size()); }
  /// What of a row's force and area is the contact's.
  [[nodiscard]] double portion(std::size_t row) const { return portions.empty() ? 1.0 : portions[row]; }
  /// Places of rows of which it has a part, ascending.
  [[nodiscard]] std::vector<std::size_t> ownRows() const {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < firstNodes.size(); ++row)
      if (portion(row) > 0)
        rows.push_back(row);
    return rows;
  }
  /// action(node of the first surface, weight) for what moves the row of a place.
  template <class Action>
  void forEachFirst(std::size_t place, const Action& action) const {
    if (firstShares.empty())
      return action(NodeShare{firstNodes[place], 1.0});
    for (const NodeShare& share : firstShares[place])
      action(share);
  }
  /// action(place of a node, weight) for all nodes of a row.
  template <class Action>
  void forEachShare(std::size_t row, const Action& action) const {
    if (combinations.empty())
      return action(row, 1.0);
    for (const Share& share : combinations[row])
      action(share.node, share.weight);
  }
};

} // namespace epafi::contact
