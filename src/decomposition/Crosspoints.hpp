#pragma once

/// Choice and numbering of the crosspoints.
///
/// Crosspoints are the corners of subdomains (Corners.hpp, InterfaceEnds.hpp). More are chosen where these do
/// not suffice: - an interface whose free crosspoints do not hold one side to the other (a closed loop, or
/// supported ends) gets
///    free nodes of its own that do, unless supports alone hold both its sides: each subdomain is then
///    regular, and K̄ has
///    no kernel but the bodies' own;
///  - a floating cluster in one piece gets free nodes that hold it; - nodes that a subdomain asks for. In
///  space, of elastic bodies in the plane, and where bodies are of several clusters, the averages along edges
///  are coarse unknowns too (EdgeAverages.hpp): they take the place of one node's values on each edge, which
///  counts as a crosspoint from then on.

#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/decomposition/SharedNodes.hpp"

#include <vector>

namespace epafi::decomposition {

/// A node that is a crosspoint.
struct CrosspointNode {
  NodeNumber node;
  int numFree = 0; ///< components that are unknowns
  bool operator<(const CrosspointNode& other) const { return node < other.node; }
};

/// All crosspoints, on every rank: the coarse problem's size.
class Crosspoints {
public:
  /// \param inside  the nodes that subdomains of one cluster share, and no others: the only ones that are
  /// crosspoints, but for those of a cluster in one piece, whose nodes no other has
  /// \param shared  all that subdomains share
  /// Collective. \throws InputError, the same on all ranks, if a floating cluster in one piece has too few
  /// such nodes.
  Crosspoints(const Substructures& all, const SharedNodes& inside, const SharedNodes& shared);

  [[nodiscard]] bool isCrosspoint(SubdomainPlace subdomain, NodePlace place) const {
    return isCrosspoint_[subdomain][place] != 0;
  }
  /// Edges' averages, edge by edge.
  [[nodiscard]] const std::vector<EdgeAverage>& averages(SubdomainPlace subdomain) const {
    return averages_[subdomain];
  }
  /// Number of crosspoints proper, edges' averages left out.
  [[nodiscard]] GlobalOrdinal numNodes() const { return numCorners_; }
  /// Number of free unknowns at crosspoints.
  [[nodiscard]] GlobalOrdinal numUnknowns() const { return numUnknowns_; }
  /// Coarse unknown of a crosspoint's first free component; the next ones follow.
  [[nodiscard]] CoarseNumber firstIndex(NodeNumber node) const;

private:
  std::vector<std::vector<char>> isCrosspoint_; ///< of each node of this rank's subdomains
  std::vector<std::vector<EdgeAverage>> averages_;
  std::vector<CrosspointNode> nodes_; ///< ascending
  GlobalOrdinal numCorners_ = 0;
  std::vector<GlobalOrdinal> firstIndex_; ///< of each node's free components
  GlobalOrdinal numUnknowns_ = 0;
};

} // namespace epafi::decomposition
