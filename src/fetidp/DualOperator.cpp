#include "epafi/fetidp/DualOperator.hpp"

#include <utility>

namespace epafi::fetidp {

DualOperator::DualOperator(std::shared_ptr<const GeneralizedInverse> inverse)
    : SymmetricOperator(inverse->multiplierPlan()->getSourceMap()), inverse_(std::move(inverse)),
      input_(inverse_->multiplierPlan()), output_(inverse_->multiplierPlan()) {}

void DualOperator::multiply(const MultiVector& x, MultiVector& y) const {
  const std::span<const double> lambda = input_.toSubdomains(x);
  inverse_->applyDual(lambda, output_.values(x.getNumVectors()), static_cast<int>(x.getNumVectors()), work_);
  output_.sumToOwners(y);
}

} // namespace epafi::fetidp
