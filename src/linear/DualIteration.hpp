#pragma once

/// Conjugate gradients on F λ = d̃ for several right-hand sides at once (Belos), until the primal residual is small.

#include "epafi/linear/PrimalResidual.hpp"

#include <span>

namespace epafi::linear {

struct DualOutcome {
  enum class Status { reached, limit, indefinite };
  Status status = Status::reached;
  int steps = 0;
};

/// λ, from λ on, all columns in one product with F a step. The primal residual is looked at in the beginning and then where the
/// dual one has fallen as far as it is expected to take, which is some three to five times in all.
/// \param goals  what ‖b − Ku‖ of each column may be
/// Collective. Precondition: F symmetric positive definite on the span of d̃'s Krylov space, M positive definite or null.
DualOutcome iterateDual(const RCP<const Operator>& f, const RCP<const Operator>& m,
                        const RCP<const MultiVector>& rhs, const RCP<MultiVector>& lambda,
                        PrimalResidual& primal, std::span<const double> goals, int maxSteps);

} // namespace epafi::linear
