#pragma once

/// α of u = K̄⁺(f̄ − B̄ᵀλ) + Rα: how far floating clusters of subdomains move until they fit together as
/// bodies, and how far these move until the contacts that carry force are closed.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fetidp {

/// Whether the contacts are asked if they leave room: where λ solves the dual problem. A force holds if it is
/// more than the tolerance leaves of nothing, and what it moves where bodies are softest is more than the gap
/// that is left.
struct RestCheck {
  bool isWanted = false;
  double leastForce = 0;  ///< equilibrium's tolerance, as a force
  double flexibility = 0; ///< ‖F‖
  double margin =
      0; ///< gaps narrower than this beside the largest count as closed where forces are not asked
};

/// Solves G̃ᵀα = c − B̄K̄⁺(f̄ − B̄ᵀλ) by least squares, first over the rows that glue clusters, then, by
/// motions of whole bodies, over those with λ_I > 0. Where these leave a part of α open, the shortest such
/// part that the other contacts allow is taken.
/// \param entries   this rank's rows of G̃ᵀ, see kernelConstraint
/// \param slack     c − B̄K̄⁺(f̄ − B̄ᵀλ)
/// \throws SolvabilityError (not unique) if the check is wanted and the contacts leave room for a motion that
/// costs nothing. The same on all ranks. Collective.
Eigen::VectorXd rigidMotion(const decomposition::DecomposedProblem& problem,
                            const decomposition::ProblemData& data, const std::vector<KernelEntry>& entries,
                            const Vector& lambda, const Vector& slack, const RestCheck& check);

} // namespace epafi::fetidp
