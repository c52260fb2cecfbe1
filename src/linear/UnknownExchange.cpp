#include "epafi/linear/UnknownExchange.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <string>

namespace epafi::linear {
namespace {

/// All numbers of this rank's subdomains, ascending, once each.
std::vector<GlobalOrdinal> numbersOf(const GlobalUnknowns& unknowns) {
  std::vector<GlobalOrdinal> numbers;
  for (const std::vector<GlobalOrdinal>& list : unknowns)
    numbers.insert(numbers.end(), list.begin(), list.end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// \throws InputError if a number is on no rank of the map. Collective.
void requireOnMap(const Map& map, const std::vector<GlobalOrdinal>& numbers) {
  std::vector<int> ranks(numbers.size());
  map.getRemoteIndexList(Teuchos::arrayViewFromVector(numbers), Teuchos::arrayViewFromVector(ranks));
  collectively(*map.getComm(), [&] {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (ranks[i] < 0)
        throw InputError("a subdomain has the unknown with the global number " + std::to_string(numbers[i]) +
                         ", but the map of the whole problem has no such number; give it all of them");
  });
}

} // namespace

UnknownExchange::UnknownExchange(const RCP<const Map>& map, const GlobalUnknowns& unknowns) : map_(map) {
  const std::vector<GlobalOrdinal> numbers = numbersOf(unknowns);
  requireOnMap(*map, numbers);
  const RCP<const Map> touched =
      rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                  Teuchos::arrayViewFromVector(numbers), map->getIndexBase(), map->getComm()));
  import_ = rcp(new Import(map, touched));
  touched_ = rcp(new MultiVector(touched, 1));
  for (const std::vector<GlobalOrdinal>& list : unknowns) {
    std::vector<int>& places = places_.emplace_back();
    places.reserve(list.size());
    for (const GlobalOrdinal number : list)
      places.push_back(
          static_cast<int>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin()));
  }
}

void UnknownExchange::prepareColumns(std::size_t numColumns) const {
  if (touched_->getNumVectors() != numColumns)
    touched_ = rcp(new MultiVector(touched_->getMap(), numColumns));
}

void UnknownExchange::toSubdomains(const MultiVector& x, SubdomainVectors& u) const {
  prepareColumns(x.getNumVectors());
  touched_->doImport(x, *import_, Tpetra::INSERT);
  const auto columns = static_cast<Eigen::Index>(x.getNumVectors());
  u.resize(places_.size());
  for (std::size_t s = 0; s < places_.size(); ++s)
    u[s].resize(static_cast<Eigen::Index>(places_[s].size()), columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    const auto values = touched_->getData(static_cast<std::size_t>(j));
    for (std::size_t s = 0; s < places_.size(); ++s)
      for (std::size_t i = 0; i < places_[s].size(); ++i)
        u[s](static_cast<Eigen::Index>(i), j) = values[places_[s][i]];
  }
}

void UnknownExchange::sum(const SubdomainVectors& f, MultiVector& y) const {
  prepareColumns(y.getNumVectors());
  touched_->putScalar(0.0);
  for (std::size_t j = 0; j < y.getNumVectors(); ++j) {
    const auto values = touched_->getDataNonConst(j);
    for (std::size_t s = 0; s < places_.size(); ++s)
      for (std::size_t i = 0; i < places_[s].size(); ++i)
        values[places_[s][i]] += f[s](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  y.putScalar(0.0);
  y.doExport(*touched_, *import_, Tpetra::ADD);
}

} // namespace epafi::linear
