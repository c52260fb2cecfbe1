#pragma once

/// A quadratic program as dense data, and what can be recomputed of an answer from them alone, in extended
/// precision.

#include <Eigen/Dense>

#include <string>

namespace epafi::benchmarks {

using Real = long double;
using RealVector = Eigen::VectorX<Real>;
using RealMatrix = Eigen::MatrixX<Real>;

/// min ½xᵀAx − bᵀx, l ≤ x ≤ u, Bx = c.
struct DenseProgram {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd linear, lower, upper;
  Eigen::MatrixXd rows = {}; ///< B, m × n; no rows without equality constraints
  Eigen::VectorXd values = {};

  /// Without bounds and rows.
  static DenseProgram unconstrained(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& linear);

  [[nodiscard]] Eigen::Index size() const { return linear.size(); }
  [[nodiscard]] Eigen::Index numRows() const { return values.size(); }
  [[nodiscard]] Real objective(const RealVector& x) const;
  /// Ax − b + Bᵀμ.
  [[nodiscard]] RealVector gradient(const RealVector& x, const RealVector& multiplier) const;
  /// What round-off in double precision may do to the entries of `gradient` (a norm).
  [[nodiscard]] double roundOff(const Eigen::VectorXd& x, const Eigen::VectorXd& multiplier) const;
};

/// The conditions of Karush, Kuhn and Tucker, not scaled.
struct DenseResiduals {
  double stationarity = 0;     ///< ‖φ‖
  double dualFeasibility = 0;  ///< ‖β‖
  double feasibility = 0;      ///< largest violation of a bound
  double equality = 0;         ///< ‖Bx − c‖
  double relativeEquality = 0; ///< the largest |Bx − c|_i beside |B_i||x| + |c_i|
  [[nodiscard]] double projectedGradient() const;
};

DenseResiduals residuals(const DenseProgram& program, const RealVector& x, const RealVector& multiplier);

/// The smallest yᵀ(Bx − c) over the box, which is positive only if no x in the box satisfies Bx = c. Entries
/// of Bᵀy below `tolerance` · Σ |y_i|‖B_i‖ count as zero where the box has no end.
double separation(const DenseProgram& program, const Eigen::VectorXd& y, double tolerance = 1e-8);

/// Why d is no direction along which the objective falls without end inside the constraints; empty if it is
/// one. d has length 1. `tolerance` is relative: Ad = 0 to ‖A‖, Bd = 0 to ‖B‖, dᵀb > 0 to ‖b‖.
std::string whyNotRecession(const DenseProgram& program, const Eigen::VectorXd& d, double tolerance = 1e-7);

} // namespace epafi::benchmarks
