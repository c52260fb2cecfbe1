#pragma once

/// A partition of unity on the copies of unknowns: Σ R^sᵀ D^s R^s = I. It shares a force out among the subdomains that meet at an
/// unknown, and makes one value of its copies, their mean Σ R^sᵀ D^s u^s.

#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/linear/UnknownExchange.hpp"

#include <vector>

namespace epafi::linear {

class CopyShares {
public:
  /// Shares proportional to the diagonals of K^s (stiffness) or equal (multiplicity). \param exchange  of the problem's unknowns
  /// Collective.
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
