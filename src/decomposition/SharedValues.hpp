#pragma once

/// What the copies of shared nodes have to know of each other before rows of B join them.

#include "epafi/decomposition/Pieces.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::decomposition {

/// Copies a node can have at most: keys of nodes are multiplied by it.
constexpr GlobalOrdinal maxCopies = 64;

/// A copy of a shared node.
struct SharedNode {
  std::size_t piece = 0;
  std::size_t place = 0; ///< in the piece's Sharing
};

/// For each body the number of the nodes of all bodies before it: its first node's, if all are numbered in one go.
std::vector<GlobalOrdinal> firstNodesOf(const Outline& outline);

/// The numbers of all copies of some nodes, told by each to the others: for each of `nodes` a matrix copies × k, in the
/// order of the parts.
/// \param nodes  on all ranks together with each node all its copies, none twice
/// \param own    the numbers of `nodes`, one row each, k columns, k the same on all ranks
/// Collective.
std::vector<Eigen::MatrixXd> valuesOfCopies(const Outline& outline, const std::vector<Piece>& pieces,
                                            const std::vector<SharedNode>& nodes, const Eigen::MatrixXd& own,
                                            const RCP<const Comm>& comm);

/// The stiffness of a node's values in a piece, diag K^s, component by component; 0 where it is prescribed.
Eigen::RowVectorXd stiffnessOf(const Piece& piece, std::size_t node, std::size_t components);

} // namespace epafi::decomposition
