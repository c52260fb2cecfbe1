#pragma once

/// Between vectors of the whole problem and this rank's subdomains: the restrictions R^s and their transposes. Built once.

#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/linear/GlobalUnknowns.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_MultiVector.hpp>

#include <vector>

namespace epafi::linear {

using fetidp::SubdomainVectors;

class UnknownExchange {
public:
  /// \param map  one-to-one; has every one of `unknowns`. \throws InputError if it has not.
  /// Collective.
  UnknownExchange(const RCP<const Map>& map, const GlobalUnknowns& unknowns);

  [[nodiscard]] const RCP<const Map>& map() const { return map_; }
  /// u^s = R^s x, n_s × k each. One message to each neighbour. Collective.
  void toSubdomains(const MultiVector& x, SubdomainVectors& u) const;
  /// y = Σ R^sᵀ f^s, f^s n_s × k each, k the columns of y. One message to each neighbour. Collective.
  void sum(const SubdomainVectors& f, MultiVector& y) const;

private:
  void prepareColumns(std::size_t numColumns) const;

  RCP<const Map> map_;
  RCP<const Import> import_;             ///< from map_ to the numbers that this rank's subdomains have
  std::vector<std::vector<int>> places_; ///< of each subdomain's unknowns among those numbers
  mutable RCP<MultiVector> touched_;     ///< work
};

} // namespace epafi::linear
