#include "epafi/fetidp/ProjectedOperator.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

ProjectedOperator::ProjectedOperator(RCP<const Operator> dualOperator,
                                     RCP<const NaturalCoarseSpace> coarseSpace)
    : dualOperator_(std::move(dualOperator)), coarseSpace_(std::move(coarseSpace)),
      projected_(dualOperator_->getDomainMap()), image_(dualOperator_->getRangeMap()) {}

void ProjectedOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                              double beta) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    projected_.assign(in);
    coarseSpace_->project(projected_);        // Px
    dualOperator_->apply(projected_, image_); // FPx
    coarseSpace_->project(image_);            // PFPx
    out.update(alpha, image_, beta);
  });
}

} // namespace epafi::fetidp
