#pragma once

/// A + ρBᵀB, the Hessian of the augmented Lagrangian; with A absent, BᵀB alone.

#include "epafi/base/Types.hpp"
#include "epafi/qp/EqualityConstraint.hpp"

#include <Tpetra_Operator.hpp>

#include <vector>

namespace epafi::qp {

class PenalizedOperator final : public Operator {
public:
  /// \param a        null for A = 0
  /// \param map      the map of x
  /// \param penalty  ρ ≥ 0
  PenalizedOperator(RCP<const Operator> a, RCP<const Map> map, RCP<const EqualityConstraint> b,
                    double penalty);

  void setPenalty(double penalty) { penalty_ = penalty; }

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  /// y = alpha (A + ρBᵀB) x + beta y; one message of B's size beside those of A. Mode must be no-transpose or
  /// transpose (the operator is symmetric). Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

private:
  RCP<const Operator> a_;
  RCP<const Map> map_;
  RCP<const EqualityConstraint> b_;
  double penalty_;
  mutable std::vector<double> bx_;
};

} // namespace epafi::qp
