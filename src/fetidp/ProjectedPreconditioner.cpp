#include "epafi/fetidp/ProjectedPreconditioner.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

ProjectedPreconditioner::ProjectedPreconditioner(RCP<const Operator> m,
                                                 RCP<const NaturalCoarseSpace> coarseSpace, double penalty)
    : SymmetricOperator(m->getDomainMap()), m_(std::move(m)), coarseSpace_(std::move(coarseSpace)),
      penalty_(penalty), projected_(getDomainMap()) {}

void ProjectedPreconditioner::multiply(const MultiVector& x, MultiVector& y) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    projected_.assign(in);
    coarseSpace_->project(projected_); // Px
    m_->apply(projected_, out);        // MPx
    coarseSpace_->project(out);        // PMPx
    const double share = 1.0 / penalty_;
    out.update(share, in, -share, projected_, 1.0); // + ρ⁻¹(x − Px)
  });
}

} // namespace epafi::fetidp
