#include "epafi/decomposition/Splitting.hpp"

#include "epafi/base/Maps.hpp"

#include <Tpetra_Map.hpp>

#include <utility>

namespace epafi::decomposition {

Splitting splitUnknowns(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints) {
  Splitting splitting;
  for (std::size_t s = 0; s < all.size(); ++s) {
    Split& split = splitting.subdomains.emplace_back();
    split.remainderUnknowns.reserve(all.subdomains[s].unknownPosition.size());
    for (std::size_t node = 0; node < all.numNodes(s); ++node) {
      const bool isCrosspoint = crosspoints.isCrosspoint(s, node);
      const bool owned = isCrosspoint && shared.isLowest(s, node);
      GlobalOrdinal index = 0;
      if (isCrosspoint)
        index = crosspoints.firstIndex(all.globalNode(s, node));
      for (const int unknown : all.unknownsAt(s, node)) {
        if (unknown < 0)
          continue;
        if (!isCrosspoint) {
          split.remainderUnknowns.push_back(unknown);
          continue;
        }
        split.crosspointUnknowns.push_back(unknown);
        split.crosspointIndices.emplace_back(index);
        if (owned)
          splitting.ownedCrosspoints.push_back(index);
        ++index;
      }
    }
  }
  return splitting;
}

Constraints joinRows(const std::vector<std::vector<RowEntry>>& contact,
                     const std::vector<GlobalOrdinal>& ownContact, const GluingRows& gluing,
                     const RCP<const Comm>& comm) {
  std::vector<GlobalOrdinal> owned = ownContact, touched;
  owned.insert(owned.end(), gluing.owned.begin(), gluing.owned.end());
  for (const std::vector<RowEntry>& rows : contact)
    for (const RowEntry& entry : rows)
      touched.push_back(entry.row);
  touched.insert(touched.end(), gluing.owned.begin(), gluing.owned.end());
  touched.insert(touched.end(), gluing.elsewhere.begin(), gluing.elsewhere.end());
  Constraints result{makeMap(std::move(owned), comm), makeMap(std::move(touched), comm), {}};
  for (std::size_t s = 0; s < gluing.rows.size(); ++s) {
    std::vector<ConstraintEntry>& entries = result.entries.emplace_back();
    entries.reserve(contact[s].size() + gluing.rows[s].size());
    for (const auto* rows : {&contact[s], &gluing.rows[s]})
      for (const RowEntry& entry : *rows)
        entries.push_back({result.ghostMap->getLocalElement(entry.row), entry.unknown, entry.coefficient});
  }
  return result;
}

} // namespace epafi::decomposition
