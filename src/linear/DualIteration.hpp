#pragma once

/// Conjugate gradients on F λ = d̃ for several right-hand sides at once (Belos), until the primal residual is
/// small.

#include "epafi/fetidp/precondition/ScaledConstraint.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <span>
#include <vector>

namespace epafi::linear {

/// What the residual of the dual problem is in the primal one. The torn solution u^s of some multipliers
/// jumps by r = d̃ − Fλ; its mean at the copies, u^s − B_Dᵀ r, is continuous and leaves b − Ku = Σ R^sᵀ K^s
/// B_Dᵀ r. So the residual that users ask for is known without a solve.
class PrimalResidual {
public:
  /// Keeps a reference to `k`. Collective.
  PrimalResidual(const UnassembledOperator& k, const fetidp::GeneralizedInverse& inverse,
                 fetidp::PreconditionerParameters::Scaling scaling);

  /// ‖b − Ku‖ of each column of r (n_λ × k): a sparse product a subdomain, one message to each neighbour
  /// twice. Collective.
  void norms(const MultiVector& r, std::vector<double>& result);

private:
  const UnassembledOperator& k_;
  fetidp::MultiplierExchange exchange_;
  std::vector<std::vector<double>> weights_; ///< B_D's entries, in the order of each subdomain's constraint
  SubdomainVectors jumps_, forces_;          ///< work
  RCP<MultiVector> residual_;                ///< work
};

struct DualOutcome {
  enum class Status { reached, limit, indefinite };
  Status status = Status::reached;
  int steps = 0;
};

/// λ, from λ on, all columns in one product with F a step. The primal residual is looked at in the beginning
/// and then where the dual one has fallen as far as it is expected to take, which is some three to five times
/// in all.
/// \param goals  what ‖b − Ku‖ of each column may be
/// Collective. Precondition: F symmetric positive definite on the span of d̃'s Krylov space, M positive
/// definite or null.
DualOutcome iterateDual(const RCP<const Operator>& f, const RCP<const Operator>& m,
                        const RCP<const MultiVector>& rhs, const RCP<MultiVector>& lambda,
                        PrimalResidual& primal, std::span<const double> goals, int maxSteps);

} // namespace epafi::linear
