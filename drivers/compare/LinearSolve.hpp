#pragma once

/// One linear solve by a library that users would otherwise take, with its times.

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace epafi::drivers {

/// Ku = f, K symmetric with all of it stored: its columns are its rows.
struct LinearSystem {
  Eigen::SparseMatrix<double> matrix;
  Eigen::VectorXd load;
};

struct LinearSolution {
  Eigen::VectorXd u;
  double setupSeconds = 0, solveSeconds = 0;
  int iterations = 0;
};

/// A Cholesky factorisation by CHOLMOD and one solve with it. Setup is ordering and factorisation.
/// \throws std::runtime_error if K is not positive definite or the memory does not suffice.
LinearSolution solveByCholmod(const LinearSystem& system);

/// Conjugate gradients (Belos) from 0, preconditioned by one V-cycle of MueLu, to a residual of `tolerance`
/// relative to the load. Setup is MueLu's; handing the matrix over to Tpetra, without a copy, is not
/// measured.
/// \throws std::runtime_error if that is not reached. On one rank.
LinearSolution solveByMueLu(const LinearSystem& system, double tolerance);

} // namespace epafi::drivers
