#pragma once

/// Choice and numbering of the crosspoints.
///
/// A node is a crosspoint if three or more subdomains share it, or two share it on the body's boundary: the
/// end points and the meeting points of interfaces. On a grid these are all subdomain corners but the four of
/// the body. More are chosen where these do not suffice:
///  - an interface without a free crosspoint (a closed loop, or supported ends) gets the free node in its
///  middle, unless
///    supports alone hold both its sides: each subdomain is then regular, and K̄ has no kernel but the bodies'
///    own;
///  - a floating body in one piece gets the node nearest to its centre.

#include "epafi/decomposition/Pieces.hpp"

#include <utility>
#include <vector>

namespace epafi::decomposition {

/// All crosspoints, on every rank: the coarse problem's size.
class CrosspointNumbering {
public:
  /// Marks `isCrosspoint` in the pieces. Collective.
  CrosspointNumbering(const Layout& layout, std::vector<Piece>& pieces, const Comm& comm);

  [[nodiscard]] GlobalOrdinal numNodes() const { return static_cast<GlobalOrdinal>(nodes_.size()); }
  /// Number of free unknowns at crosspoints.
  [[nodiscard]] GlobalOrdinal numUnknowns() const { return numUnknowns_; }
  /// Coarse index of a crosspoint's first free component; the next ones follow.
  [[nodiscard]] GlobalOrdinal firstIndex(int body, GlobalOrdinal node) const;

private:
  using Key = std::pair<int, GlobalOrdinal>; ///< body, node
  std::vector<Key> nodes_;                   ///< ascending
  std::vector<GlobalOrdinal> firstIndex_;    ///< of each node's free components
  GlobalOrdinal numUnknowns_ = 0;
};

} // namespace epafi::decomposition
