#include "epafi/linear/PrimalResidual.hpp"

#include "epafi/linear/NodalBasis.hpp"

#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::linear {

PrimalResidual::PrimalResidual(const UnassembledOperator& k, const fetidp::GeneralizedInverse& inverse,
                               fetidp::PreconditionerParameters::Scaling scaling)
    : k_(k), exchange_(inverse.multiplierPlan()), residual_(rcp(new MultiVector(k.getRangeMap(), 1))) {
  const fetidp::ContactCrosspoints none(k.problem(), inverse);
  weights_ =
      std::move(fetidp::scaleConstraint(k.problem(), none, scaling, inverse.multiplierPlan()).boundary);
}

void PrimalResidual::norms(const MultiVector& r, std::vector<double>& result) {
  const auto numColumns = static_cast<Eigen::Index>(r.getNumVectors());
  if (residual_->getNumVectors() != r.getNumVectors())
    residual_ = rcp(new MultiVector(k_.getRangeMap(), r.getNumVectors()));
  const auto values = exchange_.toSubdomains(r);
  const auto stride = static_cast<Eigen::Index>(values.size()) / numColumns;
  const auto& subdomains = k_.problem().subdomains;
  jumps_.resize(subdomains.size());
  forces_.resize(subdomains.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    jumps_[s].setZero(subdomains[s].stiffness->rows(), numColumns);
    for (Eigen::Index j = 0; j < numColumns; ++j) {
      const double* multipliers = values.data() + j * stride;
      const double* weight = weights_[s].data();
      for (const auto& entry : subdomains[s].constraint)
        jumps_[s](entry.unknown, j) += *weight++ * multipliers[entry.multiplier]; // B_Dᵀ r
    }
    forces_[s].noalias() = *subdomains[s].stiffness * jumps_[s];
    toForcesOfValues(subdomains[s], forces_[s]);
  }
  k_.exchange().sum(forces_, *residual_);
  result.resize(r.getNumVectors());
  residual_->norm2(Teuchos::arrayViewFromVector(result));
}

} // namespace epafi::linear
