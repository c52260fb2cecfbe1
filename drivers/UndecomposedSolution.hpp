#pragma once

/// The same discrete problem without any decomposition, solved another way: sparse LU of the saddle point
/// system with residuals in extended precision, and a primal–dual active set method (Hintermüller, Ito,
/// Kunisch, *SIAM J. Optim.* 13 (2003)). And what a solution that comes from elsewhere is worth.

#include "UndecomposedSystem.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::drivers {

struct UndecomposedSolution {
  Eigen::VectorXd unknowns;                ///< u
  Eigen::VectorXd multiplier;              ///< λ of contact and ties
  std::vector<Eigen::VectorXd> deflection; ///< of each body at its nodes
  double energy = 0;
  double contactForce = 0;
  int activeContactNodes = 0; ///< of the active set
  /// Error in the energy norm that the solution had before it was refined: what the problem's condition costs
  /// a direct solver.
  double roundOff = 0;
};

/// Each rank computes it alone. \throws std::runtime_error if the active set does not settle, or if the
/// bodies are not held by the contacts that a step closes.
UndecomposedSolution solveUndecomposed(const UndecomposedSystem& system);

/// The conditions of Karush, Kuhn and Tucker at a pair (u, λ), all relative. With D the diagonal of K and
/// ‖r‖² = rᵀD⁻¹r, which no unit and no jump of a material changes:
struct Optimality {
  double balance = 0;         ///< ‖Ku − f + Bᵀλ‖ to ‖ |K||u| + |f| + |B|ᵀ|λ| ‖
  double penetration = 0;     ///< largest of Bu − c, to the largest |u| and |c|
  double tension = 0;         ///< largest of −λ, to the largest |λ|
  double complementarity = 0; ///< Σ λ_i |c − Bu|_i to the energy of deformation and |fᵀu|
};

Optimality optimalityOf(const UndecomposedSystem& system, const Eigen::VectorXd& u,
                        const Eigen::VectorXd& multiplier);

/// ‖u − v‖_K to ‖v‖_K, or to √|fᵀv| where v does not deform the bodies.
double energyNormError(const UndecomposedSystem& system, const Eigen::VectorXd& u, const Eigen::VectorXd& v);

} // namespace epafi::drivers
