#pragma once

/// Whether multipliers of one problem mean something in another.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <cstdint>
#include <string>

namespace epafi::output {

/// What a problem's multipliers act on: the unknowns that each row of B joins, and the matrices K^s. Problems
/// that differ in loads, gaps, prescribed values and directions of contact alone have the same fingerprint,
/// on any number of ranks.
struct Fingerprint {
  GlobalOrdinal numInequalities = 0, numEqualities = 0; ///< rows of contact and of gluing
  GlobalOrdinal primalDimension = 0, numSubdomains = 0, components = 0, kernelDimension = 0;
  std::uint64_t rows =
      0; ///< sum of random numbers that belong to the entries of B: row, subdomain, node, component
  double stiffness =
      0; ///< sum of the diagonals of the K^s, each entry with a weight of its own between 1 and 2

  [[nodiscard]] GlobalOrdinal numMultipliers() const { return numInequalities + numEqualities; }
};

/// Collective.
Fingerprint fingerprintOf(const decomposition::DecomposedProblem& problem);

/// In what `other` differs from `mine`, "has 369 multipliers of contact and gluing instead of 120"; empty if
/// they agree (matrices to 1e-9: a mesh made anew differs in its last digits).
std::string differenceBetween(const Fingerprint& mine, const Fingerprint& other);

} // namespace epafi::output
