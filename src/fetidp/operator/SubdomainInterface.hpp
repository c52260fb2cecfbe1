#pragma once

/// Where the rows of B touch a subdomain, and which subdomains are one and the same.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <cstddef>
#include <vector>

namespace epafi::fetidp {

/// The unknowns of a subdomain that B touches, candidates too: Δ among the remainders, C among the crosspoint
/// values.
struct SubdomainInterface {
  std::vector<int> boundary;         ///< Δ: positions in Subdomain::remainderUnknowns, ascending
  std::vector<int> boundaryUnknowns; ///< Δ: the unknowns there
  std::vector<int> crosspoints;      ///< C: positions in Subdomain::crosspointUnknowns, ascending
  std::vector<int> positionOf;       ///< of each unknown among (Δ, C), or −1

  [[nodiscard]] std::size_t size() const { return boundary.size() + crosspoints.size(); }
  bool operator==(const SubdomainInterface& other) const = default;
};

SubdomainInterface interfaceOf(const decomposition::Subdomain& subdomain);

/// Subdomains that are identical.
struct IdenticalSubdomains {
  std::vector<std::size_t> members; ///< indices, ascending
  int numOnAllRanks = 1;            ///< of them, members included

  [[nodiscard]] bool isShared() const { return numOnAllRanks > 1; }
};

/// This rank's subdomains in groups of identical ones: equal K^s, equal remainders and crosspoints, equal
/// interface, all compared number by number. What does not enter the factors (loads, gaps, places) may
/// differ.
/// \param share  false: every subdomain is a group of its own
/// Returns the groups in the order of their first members. Collective.
std::vector<IdenticalSubdomains> groupIdentical(const decomposition::DecomposedProblem& problem, bool share);

} // namespace epafi::fetidp
