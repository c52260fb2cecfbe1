#pragma once

/// One linear solve by a library that users would otherwise take, with its times.

#include "ClosedMembranes.hpp"

#include <vector>

namespace epafi::drivers {

struct LinearSolution {
  std::vector<double> u;
  double setupSeconds = 0, solveSeconds = 0;
  int iterations = 0;
};

/// A Cholesky factorisation by CHOLMOD and one solve with it. Setup is ordering and factorisation.
/// \throws std::runtime_error if K is not positive definite or the memory does not suffice.
LinearSolution solveByCholmod(const SparseSystem& system);

/// Conjugate gradients (Belos) from 0, preconditioned by one V-cycle of MueLu, to a residual of `tolerance` relative
/// to the load. Setup is MueLu's; handing the matrix over to Tpetra, without a copy, is not measured.
/// \throws std::runtime_error if that is not reached. On one rank.
LinearSolution solveByMueLu(const SparseSystem& system, double tolerance);

} // namespace epafi::drivers
