#pragma once

/// G̃ = Rᵀ B̄ᵀ and ẽ = Rᵀ f̄: what the motions R of the floating clusters of subdomains, most often whole
/// bodies, do to the constraints, and the resultants of the loads on them.
///
/// The kernel R of a cluster satisfies the gluing inside, so that G̃ has entries in the rows of contact and
/// ties, and in those that glue clusters, each touching a few clusters: it is kept sparse, by rows of B.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fetidp {

/// One entry of G̃ᵀ in a row that this rank owns.
struct KernelEntry {
  int row;  ///< local index in multiplierMap
  int mode; ///< column of R
  double value;
};

/// G̃ᵀ by rows, this rank's. Collective.
std::vector<KernelEntry> kernelConstraint(const decomposition::DecomposedProblem& problem);

/// The same of whole bodies, which gluing does not hold: columns are the bodies' modes. \param entries see
/// kernelConstraint Not collective.
std::vector<KernelEntry> kernelConstraintOfBodies(const decomposition::DecomposedProblem& problem,
                                                  const std::vector<KernelEntry>& entries);

/// ẽ = Rᵀ f̄ for the right-hand sides of the data, on every rank. Collective.
Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem,
                           const decomposition::ProblemData& data);
/// Likewise for other loads, n_s × 1 of each of this rank's subdomains.
Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem, const SubdomainVectors& loads);

/// Resultants on whole bodies of those on clusters. Not collective.
Eigen::VectorXd onBodies(const decomposition::DecomposedProblem& problem, const Eigen::VectorXd& resultants);

} // namespace epafi::fetidp
