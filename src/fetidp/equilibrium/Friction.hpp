#pragma once

/// What friction holds of the rigid motions: a node's tangents hold while its force is less than its bound.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::fetidp {

/// Whether |λ_t| < g but for round-off. Not collective.
bool sticks(const decomposition::DecomposedProblem& problem, const decomposition::ProblemData& data,
            const decomposition::FrictionNode& node, const Vector& lambda);

/// Forces of friction that are at their bounds but for round-off are so to the last digit. Not collective.
void ontoFrictionBounds(const decomposition::DecomposedProblem& problem,
                        const decomposition::ProblemData& data, Vector& lambda);

/// This rank's rows of G̃ᵀ but those of friction whose bound is 0. \param entries see kernelConstraint
std::vector<KernelEntry> withoutIdleFriction(const decomposition::DecomposedProblem& problem,
                                             const decomposition::ProblemData& data,
                                             std::vector<KernelEntry> entries);

/// Whether a node's friction has a bound whatever presses there, Tresca's law.
bool hasBoundAlone(const decomposition::ProblemData& data, const decomposition::FrictionNode& node);

/// But those of friction that has a bound alone.
std::vector<KernelEntry> withoutBoundedFriction(const decomposition::DecomposedProblem& problem,
                                                const decomposition::ProblemData& data,
                                                std::vector<KernelEntry> entries);

/// But those of friction that slips; in space a node that slips keeps the row across its force, along which
/// it does not, in the place of its first one.
/// \param slack  in: c − Bu; out: of that row too
std::vector<KernelEntry> withoutSlip(const decomposition::DecomposedProblem& problem,
                                     const decomposition::ProblemData& data, const Vector& lambda,
                                     std::vector<KernelEntry> entries, Vector& slack);

/// \throws SolvabilityError (no solution), on all ranks alike, if no forces within the bounds of friction
/// balance the loads on floating bodies. \param resultants ẽ Collective.
void requireEnoughFriction(const decomposition::DecomposedProblem& problem,
                           const decomposition::ProblemData& data, const RCP<const NaturalCoarseSpace>& space,
                           const Eigen::VectorXd& resultants);

/// The refusal. \param missing how much, in words
[[noreturn]] void refuseSliding(const std::string& missing);

} // namespace epafi::fetidp
