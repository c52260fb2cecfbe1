#include "epafi/linear/UnknownExchange.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_Map.hpp>

#include <string>

namespace epafi::linear {
namespace {

/// \throws InputError if a number is on no rank of the map. Collective.
void requireOnMap(const Map& map, const Map& touched) {
  const auto numbers = localIndices(touched);
  std::vector<int> ranks(numbers.size());
  map.getRemoteIndexList(numbers, Teuchos::arrayViewFromVector(ranks));
  collectively(*map.getComm(), [&] {
    for (Teuchos_Ordinal i = 0; i < numbers.size(); ++i)
      if (ranks[i] < 0)
        throw InputError("a subdomain has the unknown with the global number " + std::to_string(numbers[i]) +
                         ", but the map of the whole problem has no such number; give it all of them");
  });
}

} // namespace

UnknownExchange::UnknownExchange(const RCP<const Map>& map, const GlobalUnknowns& unknowns) : map_(map) {
  const RCP<const Map> touched = touchedUnknowns(unknowns, map->getComm());
  requireOnMap(*map, *touched);
  import_ = rcp(new Import(map, touched));
  touched_ = rcp(new MultiVector(touched, 1));
  for (const std::vector<GlobalOrdinal>& list : unknowns) {
    std::vector<int>& places = places_.emplace_back();
    places.reserve(list.size());
    for (const GlobalOrdinal number : list)
      places.push_back(touched->getLocalElement(number));
  }
}

void UnknownExchange::prepareColumns(std::size_t numColumns) const {
  if (touched_->getNumVectors() != numColumns)
    touched_ = rcp(new MultiVector(touched_->getMap(), numColumns));
}

void UnknownExchange::toSubdomains(const MultiVector& x, SubdomainVectors& u) const {
  prepareColumns(x.getNumVectors());
  touched_->doImport(x, *import_, Tpetra::INSERT);
  const Eigen::Index columns = x.getNumVectors();
  u.resize(places_.size());
  for (std::size_t s = 0; s < places_.size(); ++s)
    u[s].resize(places_[s].size(), columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    const auto values = touched_->getData(j);
    for (std::size_t s = 0; s < places_.size(); ++s)
      for (std::size_t i = 0; i < places_[s].size(); ++i)
        u[s](i, j) = values[places_[s][i]];
  }
}

void UnknownExchange::sum(const SubdomainVectors& f, MultiVector& y) const {
  prepareColumns(y.getNumVectors());
  touched_->putScalar(0.0);
  for (std::size_t j = 0; j < y.getNumVectors(); ++j) {
    const auto values = touched_->getDataNonConst(j);
    for (std::size_t s = 0; s < places_.size(); ++s)
      for (std::size_t i = 0; i < places_[s].size(); ++i)
        values[places_[s][i]] += f[s](i, j);
  }
  y.putScalar(0.0);
  y.doExport(*touched_, *import_, Tpetra::ADD);
}

CopyShares::CopyShares(const decomposition::DecomposedProblem& problem, const UnknownExchange& exchange,
                       fetidp::PreconditionerParameters::Scaling scaling) {
  SubdomainVectors weights, totals;
  for (const decomposition::Subdomain& subdomain : problem.subdomains)
    if (scaling == fetidp::PreconditionerParameters::Scaling::stiffness)
      weights.emplace_back(subdomain.stiffness->diagonal());
    else
      weights.emplace_back(Eigen::VectorXd::Ones(subdomain.stiffness->rows()));
  MultiVector sum(exchange.map(), 1);
  exchange.sum(weights, sum);
  exchange.toSubdomains(sum, totals);
  for (std::size_t s = 0; s < weights.size(); ++s)
    shares_.emplace_back(weights[s].col(0).cwiseQuotient(totals[s].col(0)));
}

void CopyShares::scale(SubdomainVectors& u) const {
  for (std::size_t s = 0; s < u.size(); ++s)
    u[s].array().colwise() *= shares_[s].array();
}

} // namespace epafi::linear
