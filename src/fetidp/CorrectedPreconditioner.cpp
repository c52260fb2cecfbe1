#include "epafi/fetidp/CorrectedPreconditioner.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

CorrectedPreconditioner::CorrectedPreconditioner(const Operator& h, RCP<const Operator> m,
                                                 const OverratedColumns& columns, const Import& plan)
    : m_(std::move(m)), space_(h, columns, plan, m_.get()), residual_(m_->getDomainMap()),
      image_(m_->getRangeMap()) {}

void CorrectedPreconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/,
                                    double alpha, double beta) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    coefficients_ = space_.coefficients(in); // c = (VᵀHV)⁻¹Vᵀx
    residual_.assign(in);
    space_.subtractImage(coefficients_, residual_); // Pᵀx = x − HVc
    m_->apply(residual_, image_);
    coefficients_ -= space_.imageCoefficients(image_);
    space_.add(coefficients_, 1.0, image_); // P M Pᵀx + Vc
    out.update(alpha, image_, beta);
  });
}

} // namespace epafi::fetidp
