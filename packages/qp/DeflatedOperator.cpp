#include "epafi/qp/DeflatedOperator.hpp"

#include <Tpetra_MultiVector.hpp>

#include <utility>

namespace epafi::qp {

DeflatedOperator::DeflatedOperator(RCP<const Operator> a, ColumnSpace space)
    : SymmetricOperator(space.map()), a_(std::move(a)), space_(std::move(space)) {}

void DeflatedOperator::multiply(const MultiVector& x, MultiVector& y) const {
  a_->apply(x, y);
  space_.projectTransposed(y); // PᵀAx: what round-off leaves of UᵀAx is gone as well
}

void DeflatedOperator::complete(const MultiVector& b, MultiVector& x) const {
  MultiVector residual(b, Teuchos::Copy);
  a_->apply(x, residual, Teuchos::NO_TRANS, -1.0, 1.0);
  space_.correct(residual, x);
}

} // namespace epafi::qp
