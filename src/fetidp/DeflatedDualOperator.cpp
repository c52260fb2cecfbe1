#include "epafi/fetidp/DeflatedDualOperator.hpp"

#include <utility>

namespace epafi::fetidp {

DeflatedDualOperator::DeflatedDualOperator(RCP<const DualOperator> f, const OverratedColumns& columns)
    : f_(std::move(f)), space_(*f_, columns, *f_->inverse().multiplierPlan()),
      image_(rcp(new Vector(f_->getDomainMap()))) {}

void DeflatedDualOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/,
                                 double alpha, double beta) const {
  if (image_->getNumVectors() != x.getNumVectors())
    image_ = rcp(new MultiVector(getRangeMap(), x.getNumVectors()));
  f_->apply(x, *image_);
  for (std::size_t column = 0; column < x.getNumVectors(); ++column)
    project(*image_->getVectorNonConst(column)); // PᵀFx: what round-off leaves of UᵀFx is gone as well
  y.update(alpha, *image_, beta);
}

void DeflatedDualOperator::complete(const Vector& rhs, Vector& lambda) const {
  Vector residual(rhs, Teuchos::Copy);
  f_->apply(lambda, residual, Teuchos::NO_TRANS, -1.0, 1.0); // d̃ − Fμ
  space_.add(space_.coefficients(residual), 1.0, lambda);
}

} // namespace epafi::fetidp
