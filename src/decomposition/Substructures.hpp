#pragma once

/// This rank's subdomains each for itself, before they are joined: what the steps from here to the
/// DecomposedProblem look at, and none of them changes.

#include "epafi/decomposition/ProblemData.hpp"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace epafi::decomposition {

/// What it takes to join a subdomain to others, beside what the DecomposedProblem keeps of it. Positions are
/// nodes × components.
struct NodalSubdomain {
  std::vector<int> unknownOf;   ///< unknown at each position, −1 where there is none
  std::vector<int> borderNodes; ///< places of the nodes that other subdomains may have, ascending
  std::shared_ptr<const SparseMatrix>
      stiffness;                        ///< K^s where unknowns are values of nodes; equal ones may be shared
  std::vector<std::size_t> crosspoints; ///< places of nodes that are to be crosspoints whatever else is
};

/// Where nodes lie. Asked for at nodes of this rank's subdomains.
struct NodePlaces {
  int dimension = 2; ///< of space
  std::function<Point(int body, GlobalOrdinal node)> point;
  /// Empty if there is no mesh, and nobody knows.
  std::function<bool(int body, GlobalOrdinal node)> isBoundaryNode;
};

/// A view; keeps references.
struct Substructures {
  RCP<const Comm> comm;
  int components; ///< unknowns a node, the same everywhere
  const NodePlaces& places;
  std::span<const Body> bodies;          ///< all, on every rank
  std::span<const Subdomain> subdomains; ///< of this rank: their nodes, unknowns and kernels
  std::span<const SubdomainData> data;   ///< the same: loads and prescribed values
  std::span<const NodalSubdomain> nodal; ///< the same
  int numSubdomains;                     ///< of the whole problem; ranks have theirs in ascending order

  [[nodiscard]] std::size_t size() const { return subdomains.size(); }
  [[nodiscard]] std::size_t numNodes(SubdomainPlace s) const { return subdomains[s].nodes.size(); }
  [[nodiscard]] NodeNumber globalNode(SubdomainPlace s, NodePlace node) const {
    return bodies[subdomains[s].body].firstNode + subdomains[s].nodes[node];
  }
  /// Number of an unknown, or prescribed value, among those of all bodies.
  [[nodiscard]] GlobalOrdinal globalUnknown(SubdomainPlace s, NodePlace node, int component) const {
    return globalNode(s, node) * components + component;
  }
  [[nodiscard]] Point point(SubdomainPlace s, NodePlace node) const {
    return places.point(subdomains[s].body, subdomains[s].nodes[node]);
  }
  /// Unknown of each component of a node, −1 where it has none.
  [[nodiscard]] std::span<const int> unknownsAt(SubdomainPlace s, NodePlace node) const {
    return std::span(nodal[s].unknownOf).subspan(node * components, components);
  }
  [[nodiscard]] int numFree(SubdomainPlace s, NodePlace node) const {
    int number = 0;
    for (const int unknown : unknownsAt(s, node))
      number += unknown >= 0 ? 1 : 0;
    return number;
  }
  [[nodiscard]] bool isFree(SubdomainPlace s, NodePlace node) const { return numFree(s, node) > 0; }
};

/// The stiffness of a node's values, diag K, component by component; 0 where it has no unknown.
/// \param unknowns  of the node
/// \param[out] stiffness  as many numbers
void diagonalAt(const SparseMatrix& matrix, std::span<const int> unknowns, std::span<double> stiffness);

} // namespace epafi::decomposition
