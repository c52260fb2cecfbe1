#pragma once

/// The mean of a node's copies, on which contact acts where subdomains share a node.

#include "epafi/decomposition/Pieces.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace epafi::decomposition {

/// A node of one of this rank's pieces.
struct PieceNode {
  std::size_t piece = 0;
  std::size_t node = 0; ///< its place in the piece
};

/// The share δ_i / Σ δ_i that each copy has in a node's mean, δ = diag K^s, component by component; of nodes that are not
/// shared, and of crosspoints, there is none.
class NodeShares {
public:
  /// \param nodes  with each node all its copies, on all ranks together; some may be named twice
  /// Collective.
  NodeShares(const Outline& outline, const std::vector<PieceNode>& nodes, const std::vector<Piece>& pieces,
             const RCP<const Comm>& comm);

  /// Null if the node has no shares.
  [[nodiscard]] const Eigen::RowVectorXd* at(const PieceNode& node) const;

private:
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> numberOf_;
  std::vector<Eigen::RowVectorXd> shares_;
};

} // namespace epafi::decomposition
