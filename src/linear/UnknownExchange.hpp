#pragma once

/// Between vectors of the whole problem and this rank's subdomains: the restrictions R^s and their
/// transposes. Built once.

#include "epafi/fetidp/operator/FetiParameters.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
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

/// A partition of unity on the copies of unknowns: Σ R^sᵀ D^s R^s = I. It shares a force out among the
/// subdomains that meet at an unknown, and makes one value of its copies, their mean Σ R^sᵀ D^s u^s.
class CopyShares {
public:
  /// Shares proportional to the diagonals of K^s (stiffness) or equal (multiplicity). \param exchange of the
  /// problem's unknowns Collective.
  CopyShares(const decomposition::DecomposedProblem& problem, const UnknownExchange& exchange,
             fetidp::PreconditionerParameters::Scaling scaling);

  /// D^s u^s in all columns of all subdomains, in place. Not collective.
  void scale(SubdomainVectors& u) const;
  /// Diagonal of D^s of this rank's subdomain s.
  [[nodiscard]] const Eigen::VectorXd& of(std::size_t s) const { return shares_[s]; }

private:
  std::vector<Eigen::VectorXd> shares_;
};

} // namespace epafi::linear
