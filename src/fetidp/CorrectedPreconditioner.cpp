#include "epafi/fetidp/CorrectedPreconditioner.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

CorrectedPreconditioner::CorrectedPreconditioner(RCP<const Operator> m, qp::ColumnSpace space)
    : SymmetricOperator(m->getDomainMap()), m_(std::move(m)), space_(std::move(space)),
      residual_(getDomainMap()) {}

void CorrectedPreconditioner::multiply(const MultiVector& x, MultiVector& y) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    space_.coefficients(in, coefficients_); // c = (VᵀHV)⁻¹Vᵀx
    residual_.assign(in);
    space_.subtractImage(coefficients_, residual_); // Pᵀx = x − HVc
    m_->apply(residual_, out);
    space_.project(out);                   // P M Pᵀx
    space_.addColumns(coefficients_, out); // + Vc
  });
}

} // namespace epafi::fetidp
