#include "epafi/base/Maps.hpp"

#include "epafi/base/SortUnique.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>

namespace epafi {

RCP<const Map> makeMap(std::vector<GlobalOrdinal> indices, const RCP<const Comm>& comm) {
  if (!std::is_sorted(indices.begin(), indices.end()))
    std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return mapInOrder(indices, comm);
}

RCP<const Map> mapInOrder(const std::vector<GlobalOrdinal>& indices, const RCP<const Comm>& comm) {
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::ArrayView<const GlobalOrdinal>(indices.data(), indices.size()), 0, comm));
}

std::vector<int> ownersOf(const Map& map, std::span<const GlobalOrdinal> indices) {
  std::vector<GlobalOrdinal> numbers(indices.begin(),
                                     indices.end()); // each once: Tpetra answers no question twice
  sortUnique(numbers);
  std::vector<int> owners(numbers.size()), ranks;
  map.getRemoteIndexList(Teuchos::arrayViewFromVector(numbers), Teuchos::arrayViewFromVector(owners));
  ranks.reserve(indices.size());
  for (const GlobalOrdinal index : indices)
    ranks.push_back(owners[std::lower_bound(numbers.begin(), numbers.end(), index) - numbers.begin()]);
  return ranks;
}

} // namespace epafi
