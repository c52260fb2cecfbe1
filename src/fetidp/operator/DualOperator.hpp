#pragma once

/// F = B̄ K̄⁺ B̄ᵀ, the dual operator (paper, section on FETI-DP; design of the block form in
/// SubdomainGroup.hpp).

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"

#include <memory>
#include <utility>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric; positive definite without floating bodies, else positive definite on Ker G. A
/// product takes all columns in one pass: two sparse triangular solves or one dense product a subdomain and
/// column, two neighbour exchanges, one message of the coarse problem's size times the columns.
class DualOperator final : public SymmetricOperator {
public:
  /// Shares the inverse. \param compliance  C, or null. Collective.
  explicit DualOperator(std::shared_ptr<const GeneralizedInverse> inverse,
                        RCP<const Vector> compliance = Teuchos::null)
      : SymmetricOperator(inverse->multiplierPlan()->getSourceMap()), inverse_(std::move(inverse)),
        compliance_(std::move(compliance)), input_(inverse_->multiplierPlan()),
        output_(inverse_->multiplierPlan()) {}

  /// K̄⁺, of which F is made.
  [[nodiscard]] const GeneralizedInverse& inverse() const { return *inverse_; }

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    const std::span<const double> lambda = input_.toSubdomains(x);
    inverse_->applyDual(lambda, output_.values(x.getNumVectors()), static_cast<int>(x.getNumVectors()),
                        work_);
    output_.sumToOwners(y);
    if (!compliance_.is_null())
      y.elementWiseMultiply(1.0, *compliance_, x, 1.0);
  }

  std::shared_ptr<const GeneralizedInverse> inverse_;
  RCP<const Vector> compliance_;
  mutable MultiplierExchange input_, output_;
  mutable GeneralizedInverse::Workspace work_;
};

} // namespace epafi::fetidp
