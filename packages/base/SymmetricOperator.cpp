#include "epafi/base/SymmetricOperator.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <utility>

namespace epafi {

SymmetricOperator::SymmetricOperator(RCP<const Map> map) : map_(std::move(map)) {}

void SymmetricOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                              double beta) const {
  if (alpha == 0 && beta == 0) {
    y.putScalar(0.0);
  } else if (alpha == 0) {
    y.scale(beta);
  } else if (beta == 0) {
    multiply(x, y);
    if (alpha != 1)
      y.scale(alpha);
  } else {
    if (product_.is_null() || product_->getNumVectors() != x.getNumVectors())
      product_ = rcp(new MultiVector(map_, x.getNumVectors()));
    multiply(x, *product_);
    y.update(alpha, *product_, beta);
  }
}

} // namespace epafi
