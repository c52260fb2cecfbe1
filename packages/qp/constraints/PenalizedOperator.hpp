#pragma once

/// A + ρBᵀWB, the Hessian of the augmented Lagrangian (W: EqualityConstraint.hpp); with A absent, BᵀWB alone.

#include "epafi/base/Columns.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"

#include <utility>
#include <vector>

namespace epafi::qp {

/// A product costs one with A and one message of B's size.
class PenalizedOperator final : public SymmetricOperator {
public:
  /// \param a        null for A = 0
  /// \param map      the map of x
  /// \param penalty  ρ ≥ 0
  PenalizedOperator(RCP<const Operator> a, RCP<const Map> map, RCP<const EqualityConstraint> b,
                    double penalty)
      : SymmetricOperator(std::move(map)), a_(std::move(a)), b_(std::move(b)), penalty_(penalty),
        bx_(b_->numEntries()), weighed_(bx_.size()) {}

  void setPenalty(double penalty) { penalty_ = penalty; }

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    if (a_.is_null())
      y.putScalar(0.0);
    else
      a_->apply(x, y);
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      b_->product(in, bx_);
      b_->weigh(bx_, weighed_);
      b_->addTransposedProduct(weighed_, penalty_, out);
    });
  }

  RCP<const Operator> a_;
  RCP<const EqualityConstraint> b_;
  double penalty_;
  mutable std::vector<double> bx_, weighed_; ///< Bx, WBx
};

} // namespace epafi::qp
