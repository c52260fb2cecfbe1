#pragma once

/// α of u = K̄⁺(f̄ − B̄ᵀλ) + Rα: how far the floating bodies move until the contacts that carry force are
/// closed.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fetidp {

/// Solves G̃ᵀα = c − B̄K̄⁺(f̄ − B̄ᵀλ) by least squares over the rows with λ_I > 0. Where these leave a part of α
/// open, the shortest such part that the other contacts allow is taken.
/// \param entries   this rank's rows of G̃ᵀ
/// \param slack     c − B̄K̄⁺(f̄ − B̄ᵀλ)
/// \param isSolved  whether λ solves the dual problem; if not, nothing is concluded from forces that vanish
/// \throws SolvabilityError (not unique) if `isSolved` and the contacts leave room for a motion that costs
/// nothing. The same on all ranks. Collective.
Eigen::VectorXd rigidMotion(const decomposition::DecomposedProblem& problem,
                            const std::vector<KernelEntry>& entries, const Vector& lambda,
                            const Vector& slack, bool isSolved);

} // namespace epafi::fetidp
