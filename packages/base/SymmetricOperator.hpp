#pragma once

/// What operators with the same map on both sides have in common.

#include "epafi/base/Types.hpp"

#include <Tpetra_Operator.hpp>

namespace epafi {

/// y = alpha A x + beta y for an operator that equals its transpose; a class that derives says what A x is.
class SymmetricOperator : public Operator {
public:
  explicit SymmetricOperator(RCP<const Map> map);

  [[nodiscard]] RCP<const Map> getDomainMap() const final { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const final { return map_; }
  [[nodiscard]] bool hasTransposeApply() const final { return true; }
  /// With beta = 0, y is overwritten, whatever it holds. x and y are different. Allocates only where both
  /// alpha and beta are not 0: a vector for A x, at the first such call and where the number of columns
  /// changes. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const final;

protected:
  /// y = A x for any number of columns; y may hold anything before.
  virtual void multiply(const MultiVector& x, MultiVector& y) const = 0;

private:
  RCP<const Map> map_;
  mutable RCP<MultiVector> product_; ///< A x, where y is still needed; null until then
};

} // namespace epafi
