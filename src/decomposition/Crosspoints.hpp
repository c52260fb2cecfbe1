#pragma once

/// Choice and numbering of the crosspoints.
///
/// Crosspoints are the corners of subdomains (Corners.hpp). More are chosen where these do not suffice:
///  - an interface whose free crosspoints do not hold one side to the other (a closed loop, or supported ends) gets
///    free nodes of its own that do, unless supports alone hold both its sides: each subdomain is then regular, and K̄ has
///    no kernel but the bodies' own;
///  - a floating body in one piece gets free nodes that hold it;
///  - nodes that a piece has `chosen`.
/// In space, and of elastic bodies in the plane, the averages along edges are coarse unknowns too (EdgeAverages.hpp): they
/// take the place of one node's values on each edge, which counts as a crosspoint from then on.

#include "epafi/decomposition/Pieces.hpp"

#include <utility>
#include <vector>

namespace epafi::decomposition {

/// A node that is a crosspoint.
struct CrosspointNode {
  int body = 0;
  GlobalOrdinal number = 0; ///< in the body
  int numFree = 0;          ///< components that are unknowns
  bool operator<(const CrosspointNode& other) const {
    return std::pair(body, number) < std::pair(other.body, other.number);
  }
};

/// All crosspoints, on every rank: the coarse problem's size.
class CrosspointNumbering {
public:
  /// Marks `isCrosspoint` in the pieces and fills their `averages`. Collective.
  CrosspointNumbering(const Outline& outline, std::vector<Piece>& pieces, const Comm& comm);

  /// Number of crosspoints proper, edges' averages left out.
  [[nodiscard]] GlobalOrdinal numNodes() const { return numCorners_; }
  /// Number of free unknowns at crosspoints.
  [[nodiscard]] GlobalOrdinal numUnknowns() const { return numUnknowns_; }
  /// Coarse index of a crosspoint's first free component; the next ones follow.
  [[nodiscard]] GlobalOrdinal firstIndex(int body, GlobalOrdinal node) const;

private:
  void addCarriers(const Outline& outline, std::vector<Piece>& pieces, const Comm& comm);

  std::vector<CrosspointNode> nodes_; ///< ascending
  GlobalOrdinal numCorners_ = 0;
  std::vector<GlobalOrdinal> firstIndex_; ///< of each node's free components
  GlobalOrdinal numUnknowns_ = 0;
};

} // namespace epafi::decomposition
