#include "epafi/fetidp/DualOperator.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

DualOperator::DualOperator(const decomposition::DecomposedProblem& problem,
                           std::shared_ptr<GeneralizedInverse> inverse)
    : map_(problem.multiplierMap), inverse_(std::move(inverse)), input_(problem), output_(problem),
      result_(map_) {}

void DualOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                         double beta) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    const std::span<const double> lambda = input_.toSubdomains(in);
    inverse_->applyDual(lambda, output_.values());
    output_.sumToOwners(result_);
    out.update(alpha, result_, beta); // beta = 0 overwrites, NaN included
    ++applications_;
  });
}

} // namespace epafi::fetidp
