#pragma once

/// Between values of nodes and the unknowns of a subdomain, some of which may stand for averages along edges
/// and for deviations from them (decomposition/EdgeAverages.hpp): u = T ũ. Forces at nodes f do the work f·u,
/// so that those at unknowns are Tᵀf. T is the identity where there are no averages.
/// decomposition::toNodalValues is T itself. Nothing is collective.

#include "epafi/fetidp/operator/GeneralizedInverse.hpp"

namespace epafi::linear {

/// ũ = T⁻¹ u in all columns, in place.
void toUnknowns(const decomposition::Subdomain& subdomain, Eigen::MatrixXd& u);
/// u = T ũ likewise.
void toValues(const decomposition::Subdomain& subdomain, Eigen::MatrixXd& u);
/// f̃ = Tᵀ f likewise.
void toForcesOfUnknowns(const decomposition::Subdomain& subdomain, Eigen::MatrixXd& f);
/// f = T⁻ᵀ f̃ likewise.
void toForcesOfValues(const decomposition::Subdomain& subdomain, Eigen::MatrixXd& f);

} // namespace epafi::linear
