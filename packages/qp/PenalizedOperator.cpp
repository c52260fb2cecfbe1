#include "epafi/qp/PenalizedOperator.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <utility>

namespace epafi::qp {

PenalizedOperator::PenalizedOperator(RCP<const Operator> a, RCP<const EqualityConstraint> g, double penalty)
    : a_(std::move(a)), g_(std::move(g)), penalty_(penalty), sums_(static_cast<std::size_t>(g_->size())),
      gx_(sums_.size()) {}

RCP<const Map> PenalizedOperator::getDomainMap() const {
  return a_->getDomainMap();
}
RCP<const Map> PenalizedOperator::getRangeMap() const {
  return a_->getRangeMap();
}

void PenalizedOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
                              double beta) const {
  a_->apply(x, y, mode, alpha, beta);
  const Comm& comm = *getDomainMap()->getComm();
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    std::fill(sums_.begin(), sums_.end(), AccurateSum());
    g_->addLocalProduct(*x.getVector(column), sums_);
    sumOverRanks(comm, sums_);
    g_->finishProduct(sums_, gx_);
    g_->addTransposedProduct(gx_, alpha * penalty_, *y.getVectorNonConst(column));
  }
}

} // namespace epafi::qp
