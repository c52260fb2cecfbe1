#pragma once

/// Which motions of bodies, or of clusters of subdomains, supports leave free, found from the matrices.

#include "epafi/decomposition/SharedNodes.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::decomposition {

/// One of this rank's subdomains, as far as it matters for the kernel.
struct Motions {
  int group = 0;                           ///< what moves as one: its body, or its cluster
  const SparseMatrix* stiffness = nullptr; ///< K^s of the free unknowns, n_s × n_s
  Eigen::MatrixXd near;                    ///< Z^s, n_s × k: the near-kernel at them
};

/// The combinations x of the near-kernel of each group for which Σ ‖K^s Z^s x‖² vanishes beside ‖Z^s x‖²,
/// both weighted with diag K^s; x as orthonormal in the latter as round-off allows. Then R^s = Z^s x are the
/// modes of the group that supports leave free. Two sums over the ranks of k × k numbers a group. Collective.
/// Precondition: k is the same in all subdomains of a group.
std::vector<Eigen::MatrixXd> findFreeMotions(const std::vector<Motions>& motions, const Comm& comm,
                                             std::size_t numGroups);

/// \throws InputError on all ranks if subdomains of one body do not hang together through shared nodes.
/// Collective.
void requireConnected(const Substructures& all, const SharedNodes& shared);

} // namespace epafi::decomposition
