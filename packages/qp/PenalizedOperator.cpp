#include "epafi/qp/PenalizedOperator.hpp"

#include "epafi/base/Columns.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::qp {

PenalizedOperator::PenalizedOperator(RCP<const Operator> a, RCP<const Map> map,
                                     RCP<const EqualityConstraint> b, double penalty)
    : a_(std::move(a)), map_(std::move(map)), b_(std::move(b)), penalty_(penalty), bx_(b_->numEntries()) {}

void PenalizedOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
                              double beta) const {
  if (a_.is_null() && beta == 0)
    y.putScalar(0.0);
  else if (a_.is_null())
    y.scale(beta);
  else
    a_->apply(x, y, mode, alpha, beta);
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    b_->product(in, bx_);
    b_->addTransposedProduct(bx_, alpha * penalty_, out);
  });
}

} // namespace epafi::qp
