#pragma once

/// How a solution changes with its loads and gaps while contact stays as it is: the linear problem that is
/// left when closed contacts are joints and open ones are not there,
///   min ½u̇ᵀKu̇ − ḟᵀu̇  subject to  B_a u̇ = ċ_a,   a: the closed rows of contact, ties and gluing,
/// the derivative of u(f + sḟ, c + sċ) at s = 0 wherever every closed contact carries force and every open
/// one has room. Sensitivities, and the dual solutions of error estimates for quantities: by the theorem of
/// the envelope the least energy E has −dE/ds = ḟᵀu + ċᵀλ, so that data that move with a quantity J = ḟᵀu +
/// ċᵀλ have its dual solution as response.

#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/solve/ContactSolution.hpp"
#include "epafi/fetidp/solve/DualProblem.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::fetidp {

/// What moves, per unit of s.
struct DataChange {
  std::vector<Eigen::VectorXd> load; ///< ḟ^s of each of this rank's subdomains, n_s
  RCP<const Vector> gap; ///< ċ on multiplierMap, of which rows of contact and ties count; null for 0
};

/// What follows.
struct ContactResponse {
  std::vector<Eigen::VectorXd> displacement; ///< u̇ at all positions, in space; 0 where supports hold
  RCP<Vector> multiplier;                    ///< λ̇ on multiplierMap; 0 in open rows
  qp::SolveReport report;
};

/// A load has a resultant on a floating body that its closed contacts cannot take; thrown on all ranks.
class UnheldResultant : public Error {
public:
  using Error::Error;
};

/// The same in the subdomains' unknowns.
struct UnknownsResponse {
  SubdomainVectors unknowns; ///< u̇ of each of this rank's subdomains, n_s × 1, rigid motions too
  RCP<Vector> multiplier;    ///< λ̇
  qp::SolveReport report;
};

/// CG on P F_aa P, P = I − G_aᵀG_a, with M restricted to a: equilibrium is held exactly, no outer iteration.
/// Rigid motions that closed contacts leave free are left out of u̇.
/// \param closed     1 in the closed rows of contact, 0 in the open ones (ContactSolution::active)
/// \param tolerance  on ‖residual‖ relative to ‖P d̃‖
/// Collective. \throws UnheldResultant.
UnknownsResponse unknownsResponse(const DualProblem& dual, const Vector& closed, const DataChange& change,
                                  double tolerance);
/// Likewise, at all positions.
ContactResponse contactResponse(const DualProblem& dual, const Vector& closed, const DataChange& change,
                                double tolerance);

} // namespace epafi::fetidp
