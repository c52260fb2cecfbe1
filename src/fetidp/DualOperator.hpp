#pragma once

/// F = B̄ K̄⁺ B̄ᵀ, the dual operator (paper, section on FETI-DP; design of the block form in
/// SubdomainGroup.hpp).

#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"

#include <Tpetra_Operator.hpp>

#include <memory>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric; positive definite without floating bodies, else positive definite on Ker G.
class DualOperator final : public Operator {
public:
  /// Both are shared with the operator. Collective.
  DualOperator(const decomposition::DecomposedProblem& problem, std::shared_ptr<GeneralizedInverse> inverse);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  /// y = alpha F x + beta y, all columns in one pass: two sparse triangular solves or one dense product a subdomain and
  /// column, two neighbour exchanges, one message of the coarse problem's size times the columns. The operator is
  /// symmetric, so that `mode` does not matter. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }
  /// Columns multiplied so far.
  [[nodiscard]] int applications() const { return applications_; }
  /// K̄⁺, of which F is made.
  [[nodiscard]] const GeneralizedInverse& inverse() const { return *inverse_; }

private:
  RCP<const Map> map_;
  std::shared_ptr<GeneralizedInverse> inverse_;
  mutable MultiplierExchange input_, output_;
  mutable RCP<MultiVector> result_;
  mutable int applications_ = 0;
};

} // namespace epafi::fetidp
