#pragma once

/// K̄⁺ as an operator: on the partially assembled functions, which agree at crosspoints and may jump
/// elsewhere.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/linear/UnknownExchange.hpp"

#include <memory>

namespace epafi::linear {

/// (n_r + n_c) × (n_r + n_c), symmetric, positive definite on the complement of the kernel: K̄ K̄⁺ K̄ = K̄.
/// On its map the remainders of the subdomains come first, numbered as in DecomposedProblem::remainderMap,
/// and then the crosspoint values as in crosspointMap, both in the problem's unknowns (averages and
/// deviations where there are any). A product takes all columns in one pass: a sparse solve a subdomain and
/// column, one message of the coarse problem's size times the columns, messages of crosspoints.
class PartiallyAssembledInverse final : public SymmetricOperator {
public:
  /// Shares the inverse. Collective.
  PartiallyAssembledInverse(const decomposition::DecomposedProblem& problem,
                            std::shared_ptr<const fetidp::GeneralizedInverse> inverse);

private:
  void multiply(const MultiVector& x, MultiVector& y) const override;

  std::shared_ptr<const fetidp::GeneralizedInverse> inverse_;
  UnknownExchange exchange_;
  CopyShares shares_; ///< a crosspoint's force in equal parts, and the mean of its copies, which agree
  mutable SubdomainVectors forces_, values_; ///< work
  mutable fetidp::GeneralizedInverse::Workspace work_;
};

} // namespace epafi::linear
