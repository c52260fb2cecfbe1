#pragma once

/// A problem with bounds on a grid, ready for qp::QpSolver: min ½uᵀAu − bᵀu, l ≤ u ≤ h.

#include "epafi/benchmarks/Grid.hpp"
#include "epafi/qp/solve/QpSolver.hpp"

#include <string>

namespace epafi::benchmarks {

/// All benchmarks are dimensionless. Matrices and vectors are on one map, that of `grid`; each rank has made
/// its own rows.
struct BoundBenchmark {
  std::string name; ///< as in qp.csv
  Grid grid;
  RCP<CrsMatrix> hessian;         ///< A, n × n with n = grid.size(), symmetric positive definite
  RCP<Vector> linearTerm;         ///< b
  RCP<const Vector> lower, upper; ///< −∞ and +∞ for "no bound"; null where no unknown has one

  /// Shares the data. Not collective.
  [[nodiscard]] qp::QuadraticProgram program() const;
};

} // namespace epafi::benchmarks
