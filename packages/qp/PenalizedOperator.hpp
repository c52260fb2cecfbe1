#pragma once

/// A + ρGᵀG, the Hessian of the augmented Lagrangian.

#include "epafi/base/Types.hpp"
#include "epafi/qp/EqualityConstraint.hpp"

#include <Tpetra_Operator.hpp>

#include <vector>

namespace epafi::qp {

class PenalizedOperator final : public Operator {
public:
  /// \param penalty  ρ ≥ 0
  PenalizedOperator(RCP<const Operator> a, RCP<const EqualityConstraint> g, double penalty);

  [[nodiscard]] RCP<const Map> getDomainMap() const override;
  [[nodiscard]] RCP<const Map> getRangeMap() const override;
  /// y = alpha (A + ρGᵀG) x + beta y; one message of G's size beside those of A. Mode must be no-transpose or
  /// transpose (the operator is symmetric). Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

private:
  RCP<const Operator> a_;
  RCP<const EqualityConstraint> g_;
  double penalty_;
  mutable std::vector<AccurateSum> sums_;
  mutable std::vector<double> gx_;
};

} // namespace epafi::qp
