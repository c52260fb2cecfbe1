#include "epafi/fetidp/ProjectedPreconditioner.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

ProjectedPreconditioner::ProjectedPreconditioner(RCP<const Operator> m,
                                                 RCP<const NaturalCoarseSpace> coarseSpace, double penalty)
    : m_(std::move(m)), coarseSpace_(std::move(coarseSpace)), penalty_(penalty),
      projected_(m_->getDomainMap()), image_(m_->getRangeMap()) {}

void ProjectedPreconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/,
                                    double alpha, double beta) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    projected_.assign(in);
    coarseSpace_->project(projected_); // Px
    m_->apply(projected_, image_);     // MPx
    coarseSpace_->project(image_);     // PMPx
    const double share = 1.0 / penalty_;
    image_.update(share, in, -share, projected_, 1.0); // + ρ⁻¹(x − Px)
    out.update(alpha, image_, beta);
  });
}

} // namespace epafi::fetidp
