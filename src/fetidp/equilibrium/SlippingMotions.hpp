#pragma once

/// Rigid motions that nothing but the facets of smooth surfaces hinders.
///
/// A row of contact sees nᵀv of a motion that moves its two sides against each other by v. Where the smooth
/// surfaces' normal is known up to an angle δ (ContactPlace), |nᵀv| ≤ δ|v| is noise. The motions whose noise,
/// in the root mean square of nᵀv/δ beside |v|, is all that hinders them are found as eigenvectors (slippage
/// analysis: Gelfand, Guibas, *Eurographics Symp. Geometry Processing* 2004), and those among them that a
/// single place sees clearly are taken out: a key holds a wheel.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <Eigen/Core>

#include <functional>
#include <map>

namespace epafi::fetidp {

/// Orthonormal columns, none if a problem knows no places.
/// \param rows  this rank's rows of G̃ᵀ of whole bodies, by local index in multiplierMap; those without a
/// place hold what they meet
/// \param units   by which the modes are measured in rows and result
/// \param counts  whether a row of contact or a tie does
/// Collective.
Eigen::MatrixXd slippingMotions(const decomposition::DecomposedProblem& problem,
                                const std::map<int, Eigen::VectorXd>& rows, const Eigen::VectorXd& units,
                                const std::function<bool(int row)>& counts);

/// What is to be said of them after what the bodies can do.
inline constexpr const char* facetsAlone =
    ", which only the facets of its surfaces hinder: smooth ones would not; add a support, or hold a piece "
    "of the surface along it";

} // namespace epafi::fetidp
