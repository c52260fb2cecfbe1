#pragma once

/// The last digits of equilibrium.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"
#include "epafi/qp/constraints/ConvexSet.hpp"

#include <Eigen/Core>

namespace epafi::fetidp {

/// What the dual gradient is compared with: ‖d‖, but at most ten times what constraints lack where there is
/// no force. The distance of a contact that stays open is no size of the solution.
/// \param forces  what multipliers may be  \param d  −g at λ = 0
/// \param roundOff of its entries; what lacks no more is nothing. Collective.
double gradientReference(const qp::ConvexSet& forces, const Vector& d, double roundOff);

/// What forces and resultants are measured by, in the metric of N⁻¹: ‖ẽ‖, or ‖Pd‖/‖PFP‖ where the loads have
/// no resultant and contacts hold them from both sides. \param resultants ẽ \param gradient ‖Pd‖ \param norm
/// ‖PFP‖; 0: unknown Collective.
double equilibriumReference(const decomposition::DecomposedProblem& problem,
                            const decomposition::ProblemData& data, const NaturalCoarseSpace& space,
                            const Eigen::VectorXd& resultants, double gradient, double norm);

/// Takes out of λ what is left of G̃λ − ẽ by the shortest forces of gluing, ties and contacts that push
/// already,
///   λ ← λ − ZG̃ᵀ(G̃ZG̃ᵀ)⁻(G̃λ − ẽ),
/// again while it helps: where something is hardly held, an inverse has few digits. λ_I stays ≥ 0.
/// \param wanted  ‖G̃λ − ẽ‖, in the metric of N⁻¹, that is good enough
/// \returns what is left of it
/// Collective.
double balance(const qp::ConvexSet& forces, const NaturalCoarseSpace& space,
               const Eigen::VectorXd& resultants, double wanted, Vector& lambda);

} // namespace epafi::fetidp
