#include "epafi/qp/PenalizedOperator.hpp"

#include "epafi/base/Columns.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::qp {

PenalizedOperator::PenalizedOperator(RCP<const Operator> a, RCP<const Map> map,
                                     RCP<const EqualityConstraint> b, double penalty)
    : SymmetricOperator(std::move(map)), a_(std::move(a)), b_(std::move(b)), penalty_(penalty),
      bx_(b_->numEntries()) {}

void PenalizedOperator::multiply(const MultiVector& x, MultiVector& y) const {
  if (a_.is_null())
    y.putScalar(0.0);
  else
    a_->apply(x, y);
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    b_->product(in, bx_);
    b_->addTransposedProduct(bx_, penalty_, out);
  });
}

} // namespace epafi::qp
