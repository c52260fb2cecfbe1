#pragma once

/// The solution in the terms of the scene: displacement of every subdomain, forces and gaps of every contact
/// row.

#include "epafi/base/Types.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fetidp {

struct ContactSolution {
  /// u of each of this rank's subdomains, at all positions (nodes × components, supported ones included).
  std::vector<Eigen::VectorXd> displacement;
  RCP<Vector>
      multiplier; ///< λ on multiplierMap; a positive λ_I is the force that pushes the bodies apart at a node
  /// c − Bu on multiplierMap, where contacts give way c − Bu + Cλ: the remaining gap in rows of B_I, the jump
  /// in rows of B_E, times the row's size between clusters
  RCP<Vector> slack;
  RCP<Vector> active; ///< 1 where contact is closed, and where friction sticks, 0 elsewhere, on multiplierMap

  // How accurate it is, recomputed from u and λ alone; all relative, without units.
  double relativeProjectedGradient = 0;
  double roundOff = 0; ///< of it: what rounding displacements and gaps to doubles makes of c − Bu by itself
  double feasibility = 0; ///< largest penetration or jump, relative to the largest |u|, or |c| that is closed
  double complementarity = 0; ///< |λ_Iᵀ(c − Bu)| relative to the energy
  double equilibrium =
      0; ///< ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes (0 without floating bodies)

  /// Energy norm of the difference to the solution of the discrete problem, at most; NaN where there is no
  /// preconditioner to measure it by.
  double algebraicError = 0;
  /// With Coulomb's friction q, by which errors of its bounds shrink (qp/solve/BoundFeedback.hpp), and the
  /// products with F that it took; algebraicError is that with the bounds given, times what they make of it,
  /// 1/(1 − q) at least, ∞ where q ≥ 1. NaN, and so is algebraicError: it was not measured, as where the
  /// iteration has not ended at a solution.
  double frictionFeedback = 0;
  int feedbackMultiplications = 0;
  bool isEstimated = false; ///< ErrorBalance::estimate was last asked about this solution

  double energy = 0;       ///< ½uᵀKu − fᵀu
  double loadWork = 0;     ///< fᵀu of the loads, those at prescribed values too
  double contactForce = 0; ///< Σ λ_I
  double dissipation = 0;  ///< Σ λ_tᵀ(Bu − c) of friction, ≥ 0 but for the tolerance
  GlobalOrdinal activeContactNodes = 0;
};

} // namespace epafi::fetidp
