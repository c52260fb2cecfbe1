#include "epafi/fetidp/DualOperator.hpp"

#include <utility>

namespace epafi::fetidp {

DualOperator::DualOperator(const decomposition::DecomposedProblem& problem,
                           std::shared_ptr<GeneralizedInverse> inverse)
    : map_(problem.multiplierMap), inverse_(std::move(inverse)), input_(inverse_->multiplierPlan()),
      output_(inverse_->multiplierPlan()), result_(rcp(new MultiVector(map_, 1))) {}

void DualOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                         double beta) const {
  const std::size_t numColumns = x.getNumVectors();
  if (result_->getNumVectors() != numColumns)
    result_ = rcp(new MultiVector(map_, numColumns));
  const std::span<const double> lambda = input_.toSubdomains(x);
  inverse_->applyDual(lambda, output_.values(numColumns), static_cast<int>(numColumns));
  output_.sumToOwners(*result_);
  y.update(alpha, *result_, beta); // beta = 0 overwrites, NaN included
  applications_ += static_cast<int>(numColumns);
}

} // namespace epafi::fetidp
