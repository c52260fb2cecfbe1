#pragma once

/// Errors of a number that a solution is wanted for: J = Σ wᵀu + Σ gᵀλ, linear in displacements and forces of
/// contact. It is −dE/ds of the least energy E when the loads move by s w and the gaps by s g, and z = du/ds
/// is its dual solution (fetidp/ContactResponse.hpp). As E_h − E = ½‖u_h − u‖², its derivative is the error
/// (Becker, Rannacher, *Acta Numerica* 10 (2001)):
///   J − J_h = (u − u_h, z − z_h)_K ≈ Σ_T e_T,   e_T = ∫ (q*_u − q_u):C⁻¹:(q*_z − q_z) over an element T,
/// with recovered fluxes q* as in ErrorEstimate.hpp.

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/mesh/Mesh.hpp"
#include "epafi/model/Decompose.hpp"

#include <Eigen/Core>

#include <span>
#include <string>
#include <vector>

namespace epafi::accuracy {

/// Where displacements are looked at, and along what.
struct DisplacementTerms {
  int body = 0;                          ///< of the scene
  std::string surface;                   ///< averaged over it; empty: at a point
  Point point{};                         ///< in the body
  Eigen::Vector3d direction = {0, 0, 1}; ///< of any length but 0; membranes do without
};

/// w of the mean ∫uᵀd / ∫1 over a surface, or of uᵀd at a point, d the direction at length 1: at all
/// positions of each of this rank's subdomains, in space. Not collective. \throws InputError, the same on all
/// ranks, if the surface is not there, or the point is outside of the body.
std::vector<Eigen::VectorXd> displacementWeights(const model::Decomposition& decomposition,
                                                 const DisplacementTerms& terms);

/// How far J_h may be from J.
struct QuantityError {
  double error = 0;    ///< Σ e_T, the estimate of J − J_h
  double bar = 0;      ///< Σ |e_T|
  double dualNorm = 0; ///< ‖z_h‖_K: an error of the iteration moves J by no more than its norm times this
  std::vector<std::vector<double>> elements; ///< |e_T|, as ErrorEstimate::elements
};

/// By polarisation: 4t e_T = η_T²(u + tz) − η_T²(u − tz), t = ‖u‖/‖z‖, less where z is next to rigid; η_T is
/// what recovered fluxes see, and e_T is multiplied by what is estimated beside that of u and of z. Three
/// passes of the estimator, of order 2 four. Collective.
/// \param ofSolution  the estimate of u  \param u, z  at all positions of each of this rank's subdomains, in
/// space
QuantityError quantityError(const Comm& comm, ErrorEstimator& estimator, const ErrorEstimate& ofSolution,
                            std::span<const Eigen::VectorXd> u, std::span<const Eigen::VectorXd> z);

} // namespace epafi::accuracy
