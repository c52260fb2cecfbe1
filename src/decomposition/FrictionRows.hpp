#pragma once

#include "epafi/decomposition/ConstraintMatrix.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace epafi::decomposition {

/// Rows of friction: B_t u − c_t is by how much two surfaces slip at nodes that have a row of contact, along
/// the tangents there. A node has as many of them as it has components less one, of the same length as its
/// row of contact and perpendicular to it and each other. Where supports hold the node, one is better along
/// what they hold, the other perpendicular to what they leave of the row of contact: what supports leave of a
/// row must not be small beside the row, or preconditioners overrate it.
struct FrictionRows {
  /// B_t and c_t (the jump at the end of the last step), rows of a node one after the other, on the rank of
  /// the node's row of contact.
  ConstraintMatrix tangents;
  std::vector<GlobalOrdinal> contactRows; ///< of each node of this rank, in the order of its rows
};

/// Two directions of length 1 that are perpendicular to n, of length 1, and to each other; in the plane the
/// first is n turned by a right angle, the second that of z.
std::array<Eigen::Vector3d, 2> tangentsOf(const Eigen::Vector3d& normal);

/// Rows of friction for all rows of contact, along the tangents of the direction in which each acts: they
/// move the same nodes with the same weights. c_t = 0.
/// \param components  unknowns a node, 2 or 3; all of the nodes that contact touches are unknowns
/// \throws InputError, on all ranks alike, for a row that acts on its nodes along more than one direction.
/// Collective.
FrictionRows frictionAlong(const ConstraintMatrix& contact, int components);

} // namespace epafi::decomposition
