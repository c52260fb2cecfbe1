#pragma once

/// Two solvers of convex quadratic programs that share nothing with MPRGP and SMALBE, for tests to compare
/// with.

#include "DenseProgram.hpp"

namespace epafi::test {

struct OracleAnswer {
  bool isFeasible = true;
  RealVector x;
  RealVector multiplier; ///< μ of Bx = c, with Ax − b + Bᵀμ ≥ 0 at a lower bound, ≤ 0 at an upper one, else 0
  Real objective = 0;
  Real residual = 0; ///< ‖g^P‖ in extended precision: how well x is known
  Eigen::VectorXd
      certificate; ///< if infeasible: y with yᵀ(Bx − c) > 0 for every x in the box; empty if the box is empty
  int iterations = 0;
};

/// The dual method of Goldfarb, Idnani, *Math. Program.* 27 (1983) 1–33, in extended precision, with its
/// active set solved once more and corrected until the conditions of Karush, Kuhn and Tucker hold to
/// round-off. Rows of B may be redundant. Finite, n³ work. Precondition: A positive definite.
OracleAnswer solveByDualActiveSet(const DenseProgram& program);

/// The same for A positive semidefinite and a problem that has a solution: proximal steps
/// x ← argmin ½xᵀAx − bᵀx + δ/2‖x − x_k‖² until the residual is round-off.
OracleAnswer solveByProximalSteps(const DenseProgram& program);

/// Every choice of entries at their bounds is tried: at most 3ⁿ systems. For n ≤ 8, A positive semidefinite,
/// and a problem that is not unbounded. Fills isFeasible, x and objective.
OracleAnswer solveByEnumeration(const DenseProgram& program);

} // namespace epafi::test
