#include "epafi/fetidp/ProjectedOperator.hpp"

#include <utility>

namespace epafi::fetidp {

ProjectedOperator::ProjectedOperator(RCP<const Operator> dualOperator,
                                     RCP<const NaturalCoarseSpace> coarseSpace)
    : dualOperator_(std::move(dualOperator)), coarseSpace_(std::move(coarseSpace)),
      projected_(dualOperator_->getDomainMap()), image_(dualOperator_->getRangeMap()) {}

void ProjectedOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                              double beta) const {
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    projected_.assign(*x.getVector(column));
    coarseSpace_->project(projected_);        // Px
    dualOperator_->apply(projected_, image_); // FPx
    coarseSpace_->project(image_);            // PFPx
    y.getVectorNonConst(column)->update(alpha, image_, beta);
  }
}

} // namespace epafi::fetidp
