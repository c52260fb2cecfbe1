#include "epafi/output/Fingerprint.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"

#include <Tpetra_Map.hpp>

#include <array>
#include <cmath>

namespace epafi::output {
namespace {

/// Spreads the bits of x over all 64 (Steele, Lea, Flood, *OOPSLA* 2014: SplitMix64).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// A random number that belongs to an unknown of a subdomain, by its node and component.
std::uint64_t numberOf(const decomposition::Subdomain& subdomain, std::size_t unknown, int components) {
  const int position = subdomain.unknownPosition[unknown];
  const auto node = subdomain.nodes[static_cast<std::size_t>(position / components)];
  const auto component = static_cast<std::uint64_t>(position % components);
  return mixed(mixed(mixed(static_cast<std::uint64_t>(subdomain.number)) + static_cast<std::uint64_t>(node)) +
               component);
}

} // namespace

Fingerprint fingerprintOf(const decomposition::DecomposedProblem& problem) {
  std::uint64_t rows = 0;
  AccurateSum stiffness;
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    for (const decomposition::ConstraintEntry& entry : subdomain.constraint) {
      const auto row =
          static_cast<std::uint64_t>(problem.multiplierGhostMap->getGlobalElement(entry.multiplier));
      rows += mixed(numberOf(subdomain, static_cast<std::size_t>(entry.unknown), problem.components) + row);
    }
    for (int i = 0; i < subdomain.stiffness->rows(); ++i) {
      const double share =
          static_cast<double>(numberOf(subdomain, static_cast<std::size_t>(i), problem.components) >> 11U) /
          9007199254740992.0;
      stiffness.add((1 + share) * subdomain.stiffness->coeff(i, i));
    }
  }
  // Halves of 32 bits: their sums over the ranks are exact in doubles.
  std::array<AccurateSum, 3> sums{stiffness, AccurateSum(static_cast<double>(rows >> 32U)),
                                  AccurateSum(static_cast<double>(rows & 0xffffffffU))};
  sumOverRanks(*problem.comm, sums);
  Fingerprint fingerprint;
  fingerprint.numInequalities = problem.numInequalities;
  fingerprint.numEqualities = problem.numEqualities;
  fingerprint.primalDimension = problem.primalDimension;
  fingerprint.numSubdomains = problem.numSubdomains;
  fingerprint.components = problem.components;
  fingerprint.kernelDimension = problem.kernelDimension;
  fingerprint.rows =
      (static_cast<std::uint64_t>(sums[1].value()) << 32U) + static_cast<std::uint64_t>(sums[2].value());
  fingerprint.stiffness = sums[0].value();
  return fingerprint;
}

std::string differenceBetween(const Fingerprint& mine, const Fingerprint& other) {
  const auto counts = [](GlobalOrdinal here, const char* what, GlobalOrdinal there) {
    return "has " + std::to_string(there) + what + " instead of " + std::to_string(here);
  };
  if (other.components != mine.components)
    return counts(mine.components, " unknowns a node", other.components);
  if (other.numSubdomains != mine.numSubdomains)
    return counts(mine.numSubdomains, " subdomains", other.numSubdomains);
  if (other.primalDimension != mine.primalDimension)
    return counts(mine.primalDimension, " primal unknowns", other.primalDimension);
  if (other.numInequalities != mine.numInequalities)
    return counts(mine.numInequalities, " multipliers of contact", other.numInequalities);
  if (other.numEqualities != mine.numEqualities)
    return counts(mine.numEqualities, " multipliers of gluing", other.numEqualities);
  if (other.kernelDimension != mine.kernelDimension)
    return counts(mine.kernelDimension, " rigid modes of floating bodies", other.kernelDimension);
  if (other.rows != mine.rows)
    return "joins other nodes";
  constexpr double tolerance = 1e-9;
  if (!(std::abs(other.stiffness - mine.stiffness) <= tolerance * std::abs(mine.stiffness)))
    return "has other stiffness matrices";
  return {};
}

} // namespace epafi::output
