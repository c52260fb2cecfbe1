#pragma once

/// The parts of the DecomposedProblem that join subdomains: remainder and crosspoint values, and B over all
/// of them.

#include "epafi/decomposition/ContactRows.hpp"
#include "epafi/decomposition/GluingRows.hpp"

#include <vector>

namespace epafi::decomposition {

/// The unknowns of a subdomain, as in `Subdomain`.
struct Split {
  std::vector<int> remainderUnknowns, crosspointUnknowns;
  std::vector<CoarseNumber> crosspointIndices;
};

struct Splitting {
  std::vector<Split> subdomains;
  std::vector<GlobalOrdinal> ownedCrosspoints; ///< those of which no lower subdomain has a copy
};

/// Not collective.
Splitting splitUnknowns(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints);

/// B with its rows by local numbers, and the maps of its multipliers.
struct Constraints {
  RCP<const Map> multiplierMap, ghostMap;
  std::vector<std::vector<ConstraintEntry>> entries; ///< B^s of each subdomain
};

/// \param contact     B_I^s of each subdomain, in the basis of its unknowns
/// \param ownContact  contact rows that this rank owns
/// Collective.
Constraints joinRows(const std::vector<std::vector<RowEntry>>& contact,
                     const std::vector<GlobalOrdinal>& ownContact, const GluingRows& gluing,
                     const RCP<const Comm>& comm);

} // namespace epafi::decomposition
