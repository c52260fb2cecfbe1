#include "epafi/output/Fingerprint.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"

#include <Tpetra_Map.hpp>

#include <array>
#include <cmath>
#include <initializer_list>
#include <span>
#include <utility>

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
  const auto node = subdomain.nodes[position / components];
  const std::uint64_t component = position % components;
  return mixed(mixed(mixed(subdomain.number) + node) + component);
}

} // namespace

Fingerprint fingerprintOf(const decomposition::DecomposedProblem& problem) {
  std::uint64_t rows = 0;
  AccurateSum stiffness;
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    for (const decomposition::ConstraintEntry& entry : subdomain.constraint) {
      const std::uint64_t row = problem.numberOf(entry.multiplier);
      rows += mixed(numberOf(subdomain, entry.unknown, problem.components) + row);
    }
    for (int i = 0; i < subdomain.stiffness->rows(); ++i) {
      const double share =
          static_cast<double>(numberOf(subdomain, i, problem.components) >> 11U) / 9007199254740992.0;
      stiffness.add((1 + share) * subdomain.stiffness->coeff(i, i));
    }
  }
  // Halves of 32 bits, whose sums overflow on no number of ranks.
  std::array<GlobalOrdinal, 2> halves{static_cast<GlobalOrdinal>(rows >> 32U),
                                      static_cast<GlobalOrdinal>(rows & 0xffffffffU)};
  sumOverRanks(*problem.comm, std::span(halves));
  sumOverRanks(*problem.comm, {&stiffness, 1});
  Fingerprint fingerprint;
  fingerprint.numInequalities = problem.firstTie();
  fingerprint.numEqualities = problem.numEqualities;
  fingerprint.primalDimension = problem.primalDimension;
  fingerprint.numSubdomains = problem.numSubdomains;
  fingerprint.components = problem.components;
  fingerprint.kernelDimension = problem.kernelDimension;
  fingerprint.rows = (static_cast<std::uint64_t>(halves[0]) << 32U) + halves[1];
  fingerprint.stiffness = stiffness.value();
  return fingerprint;
}

std::string differenceBetween(const Fingerprint& mine, const Fingerprint& other) {
  using Count = GlobalOrdinal Fingerprint::*;
  const std::initializer_list<std::pair<const char*, Count>> counts{
      {"unknowns a node", &Fingerprint::components},
      {"subdomains", &Fingerprint::numSubdomains},
      {"primal unknowns", &Fingerprint::primalDimension},
      {"multipliers of contact", &Fingerprint::numInequalities},
      {"multipliers of gluing", &Fingerprint::numEqualities},
      {"rigid modes of floating bodies", &Fingerprint::kernelDimension}};
  for (const auto& [what, count] : counts)
    if (other.*count != mine.*count)
      return "has " + std::to_string(other.*count) + " " + what + " instead of " +
             std::to_string(mine.*count);
  if (other.rows != mine.rows)
    return "joins other nodes";
  constexpr double tolerance = 1e-9;
  if (!(std::abs(other.stiffness - mine.stiffness) <= tolerance * std::abs(mine.stiffness)))
    return "has other stiffness matrices";
  return {};
}

} // namespace epafi::output
