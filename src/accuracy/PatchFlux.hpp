#pragma once

/// Superconvergent patch recovery (Zienkiewicz, Zhu, *Int. J. Numer. Meth. Engng* 33 (1992)), of elements of
/// order 2. Round each vertex a polynomial in the coordinates meets the fluxes of the elements there, at the
/// points where they are most accurate, by least squares: a complete one of degree 2, of bodies of bricks one
/// of degree 2 along each axis. A vertex has the value of its own, any other node the mean of those of the
/// vertices of its edge, face or element there. Where a patch has too few points, as of bricks at a surface,
/// what is of degree 2 and more is as small as it may be.

#include "epafi/accuracy/RecoveredFlux.hpp"

#include <span>
#include <vector>

namespace epafi::accuracy {

/// The sums of the normal equations round the vertices of one subdomain, then the polynomials.
struct FluxPatches {
  Eigen::MatrixXd sums;    ///< a column a patch
  std::vector<int> ofSlot; ///< the patch of each slot, −1 where it is no vertex; empty of order 1
};

/// Values of one patch of a body.
std::size_t numPatchSums(const BodyElements& body, int numFluxes);

/// From the subdomain's own elements. \param flux  with its slots \param rows  of the sums, as many as the
/// body needs at least. Not collective.
FluxPatches sumPatches(const BodyElements& body, const decomposition::Subdomain& subdomain,
                       const Eigen::VectorXd& displacement, const SubdomainFlux& flux, std::size_t rows);

/// From the whole sums to the polynomials and their values at all slots; the last row becomes 1.
void fitPatches(const BodyElements& body, const decomposition::Subdomain& subdomain,
                const Eigen::VectorXd& displacement, FluxPatches& patches, SubdomainFlux& flux);

} // namespace epafi::accuracy
