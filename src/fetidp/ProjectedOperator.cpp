#include "epafi/fetidp/ProjectedOperator.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

ProjectedOperator::ProjectedOperator(RCP<const Operator> dualOperator,
                                     RCP<const NaturalCoarseSpace> coarseSpace)
    : SymmetricOperator(dualOperator->getDomainMap()), dualOperator_(std::move(dualOperator)),
      coarseSpace_(std::move(coarseSpace)), projected_(dualOperator_->getDomainMap()) {}

void ProjectedOperator::multiply(const MultiVector& x, MultiVector& y) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    projected_.assign(in);
    coarseSpace_->project(projected_);     // Px
    dualOperator_->apply(projected_, out); // FPx
    coarseSpace_->project(out);            // PFPx
  });
}

} // namespace epafi::fetidp
