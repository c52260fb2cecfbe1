#pragma once

/// K̄⁺ as an operator: on the partially assembled functions, which agree at crosspoints and may jump elsewhere.

#include "epafi/linear/CopyShares.hpp"

#include <Tpetra_Operator.hpp>

#include <memory>

namespace epafi::linear {

/// (n_r + n_c) × (n_r + n_c), symmetric, positive definite on the complement of the kernel: K̄ K̄⁺ K̄ = K̄. On its map the
/// remainders of the subdomains come first, numbered as in DecomposedProblem::remainderMap, and then the crosspoint values as in
/// crosspointMap, both in the problem's unknowns (averages and deviations where there are any).
class PartiallyAssembledInverse final : public Operator {
public:
  /// Both are shared. Collective.
  PartiallyAssembledInverse(std::shared_ptr<const decomposition::DecomposedProblem> problem,
                            std::shared_ptr<fetidp::GeneralizedInverse> inverse);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return exchange_.map(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return exchange_.map(); }
  /// y = alpha K̄⁺ x + beta y, all columns in one pass: a sparse solve a subdomain and column, one message of the coarse problem's
  /// size times the columns, messages of crosspoints. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

private:
  std::shared_ptr<const decomposition::DecomposedProblem> problem_;
  std::shared_ptr<fetidp::GeneralizedInverse> inverse_;
  UnknownExchange exchange_;
  CopyShares shares_; ///< a crosspoint's force in equal parts, and the mean of its copies, which agree
  mutable SubdomainVectors forces_, values_; ///< work
  mutable RCP<MultiVector> result_;          ///< work
};

} // namespace epafi::linear
