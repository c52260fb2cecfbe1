#pragma once

/// From pairs of nodes that may meet to rows of B_I over the unknowns of nodes.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/decomposition/ConstraintMatrix.hpp"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace epafi::contact {

/// What rows have to know of nodes, which are named by body and number in the body.
struct NodeUnknowns {
  int components = 1;
  std::vector<GlobalOrdinal> firstNode; ///< of each body: number of its node 0 among those of all
  /// The axes of a node's unknowns, columns of a rotation; null where they are those of space.
  std::function<const Eigen::Matrix3d*(int body, GlobalOrdinal node)> frame;
  /// Whether a support prescribes a component.
  std::function<bool(int body, GlobalOrdinal node, int component)> isHeld;
  /// Whether this rank is to own the rows of a node of the first body; true on one rank.
  std::function<bool(int body, GlobalOrdinal node)> isMine;
};

/// dᵀ(u_first − u_second) ≤ gap for all rows of all contacts. A node that supports hold in the row's
/// direction has no entry but those of its prescribed values. Collective.
/// \param contacts  the same on all ranks
decomposition::ConstraintMatrix contactMatrix(const std::vector<ContactLayout>& contacts,
                                              const NodeUnknowns& unknowns, const RCP<const Comm>& comm);

} // namespace epafi::contact
