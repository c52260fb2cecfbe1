#pragma once

/// Which motions of an application's bodies its supports leave free, found from the matrices.

#include "epafi/decomposition/SharedNodes.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::decomposition {

/// One of this rank's subdomains, as far as it matters for the kernel.
struct Motions {
  int body = 0;
  const SparseMatrix* stiffness = nullptr; ///< K^s of the free unknowns, n_s × n_s
  Eigen::MatrixXd near;                    ///< Z^s, n_s × k: the near-kernel at them
};

/// R^s of each: combinations Z^s x of the near-kernel of a body for which Σ ‖K^s Z^s x‖² vanishes beside ‖Z^s x‖², both
/// weighted with diag K^s; x as orthonormal in the latter as round-off allows. They are the modes of the body that supports
/// leave free. Fills `bodies` (kernelDimension, kernelOffset) in the order of their indices; returns x for each body. Sums
/// over the ranks of k × k numbers a body. Collective.
/// Precondition: k is the same in all subdomains of a body.
std::vector<Eigen::MatrixXd> findFreeMotions(const std::vector<Motions>& motions, const Comm& comm,
                                             std::vector<Body>& bodies);

/// \throws InputError on all ranks if subdomains of one body do not hang together through shared nodes. Collective.
void requireConnected(const Substructures& all, const SharedNodes& shared);

} // namespace epafi::decomposition
