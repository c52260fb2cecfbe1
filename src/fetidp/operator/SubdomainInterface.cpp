#include "epafi/fetidp/operator/SubdomainInterface.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/EqualMatrices.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace epafi::fetidp {
namespace {

using decomposition::Subdomain;

/// Whether B touches each unknown, or may come to.
std::vector<char> touchedBy(const Subdomain& subdomain) {
  std::vector<char> isTouched(subdomain.stiffness->rows(), 0);
  for (const auto& entry : subdomain.constraint)
    isTouched[entry.unknown] = 1;
  for (const int unknown : subdomain.candidates)
    isTouched[unknown] = 1;
  return isTouched;
}

/// Equal for identical subdomains, and rarely for others.
std::uint64_t fingerprint(const Subdomain& subdomain, const std::vector<char>& isTouched) {
  std::uint64_t hash = decomposition::fingerprint(*subdomain.stiffness);
  const auto mix = [&hash](std::uint64_t value) {
    hash = (hash ^ value) * 0x100000001b3ULL;
    hash ^= hash >> 29U;
  };
  for (const int unknown : subdomain.crosspointUnknowns)
    mix(unknown);
  for (std::size_t unknown = 0; unknown < isTouched.size(); ++unknown)
    if (isTouched[unknown] != 0)
      mix(unknown);
  return hash;
}

} // namespace

SubdomainInterface interfaceOf(const Subdomain& subdomain) {
  SubdomainInterface interface;
  const std::vector<char> isTouched = touchedBy(subdomain);
  interface.positionOf.assign(isTouched.size(), -1);
  int next = 0;
  const auto collect = [&](const std::vector<int>& unknowns, std::vector<int>& positions) {
    for (int i = 0; i < std::ssize(unknowns); ++i)
      if (isTouched[unknowns[i]] != 0) {
        positions.push_back(i);
        interface.positionOf[unknowns[i]] = next++;
      }
  };
  collect(subdomain.remainderUnknowns, interface.boundary);
  for (const int position : interface.boundary)
    interface.boundaryUnknowns.push_back(subdomain.remainderUnknowns[position]);
  collect(subdomain.crosspointUnknowns, interface.crosspoints);
  return interface;
}

std::vector<IdenticalSubdomains> groupIdentical(const decomposition::DecomposedProblem& problem, bool share) {
  const std::vector<Subdomain>& subdomains = problem.subdomains;
  std::vector<IdenticalSubdomains> groups;
  if (!share) {
    for (std::size_t s = 0; s < subdomains.size(); ++s)
      groups.push_back({{s}});
    return groups;
  }
  struct Hashed {
    std::uint64_t hash;
    int number;
  };
  std::vector<std::vector<char>> touchedOf; // of each group
  std::vector<std::uint64_t> hashOf;        // likewise
  std::unordered_multimap<std::uint64_t, std::size_t> candidates;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    std::vector<char> touched = touchedBy(subdomains[s]);
    const std::uint64_t hash = fingerprint(subdomains[s], touched);
    const auto [first, last] = candidates.equal_range(hash);
    const auto same = std::find_if(first, last, [&](const auto& candidate) {
      const Subdomain& other = subdomains[groups[candidate.second].members.front()];
      return other.crosspointUnknowns == subdomains[s].crosspointUnknowns &&
             other.remainderUnknowns == subdomains[s].remainderUnknowns &&
             touchedOf[candidate.second] == touched &&
             decomposition::areEqual(*other.stiffness, *subdomains[s].stiffness);
    });
    if (same != last) {
      groups[same->second].members.push_back(s);
      continue;
    }
    candidates.emplace(hash, groups.size());
    groups.push_back({{s}});
    touchedOf.push_back(std::move(touched));
    hashOf.push_back(hash);
  }
  std::vector<Hashed> mine;
  for (std::size_t g = 0; g < groups.size(); ++g)
    mine.push_back({hashOf[g], static_cast<int>(groups[g].members.size())});
  std::unordered_map<std::uint64_t, int> numOf;
  for (const Hashed& group : gatherOnAll(*problem.comm, mine))
    numOf[group.hash] += group.number;
  for (std::size_t g = 0; g < groups.size(); ++g)
    groups[g].numOnAllRanks = numOf[hashOf[g]];
  return groups;
}

} // namespace epafi::fetidp
