#pragma once

/// One solve of the dual problem, for the loads and gaps that the problem holds.

#include "epafi/fetidp/ErrorBalance.hpp"
#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/qp/SolveReport.hpp"

namespace epafi::fetidp {

class DualProblem;

/// What a solve stops at.
struct DualGoal {
  const ErrorBalance* balance = nullptr; ///< if the parameters ask for balance
  double tightening = 1;                 ///< factor on the tolerance, ≤ 1
};

/// λ and how it came about.
struct DualSolution {
  RCP<Vector> lambda; ///< on multiplierMap, λ_I ≥ 0
  /// ‖d̃‖ or ‖Pd‖, with Pᵀd̃ for d̃ where jumps are deflated: what residuals are relative to; the size of its terms if it
  /// vanishes.
  double reference = 0;
  double errorTarget = 0; ///< with an ErrorBalance: the algebraic error that was small enough; else 0
  double equilibrium = 0; ///< ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes
  qp::SolveReport report;
};

/// See DualProblem::solve.
DualSolution solveDual(const DualProblem& dual, const Vector* start, qp::Observer* observer,
                       const DualGoal& goal);

/// The loads that the problem holds, f^s for each of this rank's subdomains.
SubdomainVectors loadsOf(const decomposition::DecomposedProblem& problem);

} // namespace epafi::fetidp
