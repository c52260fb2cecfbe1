#pragma once

/// What the residual of the dual problem is in the primal one. The torn solution u^s of some multipliers jumps by r = d̃ − Fλ;
/// its mean at the copies, u^s − B_Dᵀ r, is continuous and leaves b − Ku = Σ R^sᵀ K^s B_Dᵀ r. So the residual that users ask for
/// is known without a solve.

#include "epafi/fetidp/ScaledConstraint.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <vector>

namespace epafi::linear {

class PrimalResidual {
public:
  /// Keeps a reference to `k`. Collective.
  PrimalResidual(const UnassembledOperator& k, const fetidp::GeneralizedInverse& inverse,
                 fetidp::PreconditionerParameters::Scaling scaling);

  /// ‖b − Ku‖ of each column of r (n_λ × k): a sparse product a subdomain, one message to each neighbour twice. Collective.
  void norms(const MultiVector& r, std::vector<double>& result);

private:
  const UnassembledOperator& k_;
  fetidp::MultiplierExchange exchange_;
  std::vector<std::vector<double>> weights_; ///< B_D's entries, in the order of each subdomain's constraint
  SubdomainVectors jumps_, forces_;          ///< work
  RCP<MultiVector> residual_;                ///< work
};

} // namespace epafi::linear
