#pragma once

/// From λ back to the scene: u = K̄⁺(f̄ − B̄ᵀλ) + Rα, with α from the rows of the active contact constraints;
/// and how accurate it is, computed afresh from u and λ.

#include "epafi/fetidp/solve/ContactSolution.hpp"
#include "epafi/fetidp/solve/DualProblem.hpp"
#include "epafi/qp/solve/Interruption.hpp"

#include <optional>

namespace epafi::fetidp {

/// K̄⁺(f̄ − B̄ᵀλ) at all positions of this rank's subdomains, components in space: u but for rigid motions of
/// floating bodies. Collective.
std::vector<Eigen::VectorXd> displacementOf(const DualProblem& dual, const decomposition::ProblemData& data,
                                            const Vector& lambda);

/// \param data   that `found` was solved for
/// \param found  λ of `dual` and its reference
/// \throws SolvabilityError if floating bodies may come to rest in more than one place (see RigidMotion.hpp).
/// Collective.
ContactSolution recover(const DualProblem& dual, const decomposition::ProblemData& data,
                        const DualSolution& found);

/// What rows may be violated by, the smaller of both.
struct AllowedViolation {
  double relative = 0; ///< to the largest displacement, or gap that is closed
  double absolute = 0; ///< 0: as the other says
};

/// The same, and what round-off leaves open of closed contacts and gluing is closed by responses of their own
/// (ContactResponse.hpp). The last digit of λ moves a body that hardly anything holds by far more than its
/// own last digit: u = K̄⁺(f̄ − B̄ᵀλ) has then fewer digits than the sum of what comes first and of what
/// follows. Nothing where that does not end with contacts that all push and with none that penetrates.
/// \param allowed  what rows may be violated by
/// \param report        where the products are added, and the status of an end before its time
/// \param interruption  asked between the responses
std::optional<ContactSolution> recoverSettled(const DualProblem& dual, const decomposition::ProblemData& data,
                                              const DualSolution& found, const AllowedViolation& allowed,
                                              qp::SolveReport& report, const qp::Interruption& interruption);

} // namespace epafi::fetidp
