#pragma once

/// Other loads and gaps for a problem, number by number.

#include "epafi/decomposition/ProblemData.hpp"

#include <Tpetra_Vector.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace epafi::decomposition {

/// The data after `change(subdomains, gap)`: the vector of SubdomainData, and the gap less what prescribed
/// values contribute. Their energies stay as they are.
template <class Change>
ProblemData changed(const ProblemData& data, const Change& change) {
  std::vector<SubdomainData> subdomains(data.subdomains().begin(), data.subdomains().end());
  Vector gap(data.gap(), Teuchos::Copy);
  change(subdomains, gap);
  return {std::move(subdomains), gap, Vector(gap.getMap())};
}

/// With `change(s, load)` of each of this rank's subdomains.
template <class Change>
ProblemData withLoads(const ProblemData& data, const Change& change) {
  return changed(data, [&](std::vector<SubdomainData>& subdomains, Vector& /*gap*/) {
    for (std::size_t s = 0; s < subdomains.size(); ++s)
      change(s, subdomains[s].load);
  });
}

} // namespace epafi::decomposition
