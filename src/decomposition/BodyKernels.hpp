#pragma once

/// Near-kernels of bodies, rigid motions most often, and the kernels R^s of an application's bodies from
/// them.

#include "epafi/decomposition/FloatingBodies.hpp"
#include "epafi/decomposition/OwnSubdomain.hpp"
#include "epafi/decomposition/Substructures.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::decomposition {

struct BodyKernels {
  std::vector<Body> bodies;             ///< with their kernels' dimensions and motions
  std::vector<Eigen::MatrixXd> kernels; ///< R^s of each of this rank's subdomains
  std::vector<Motions> near;            ///< their near-kernels
};

/// Rigid motions of each of this rank's subdomains, about the middle of its body, or constants where unknowns
/// are no displacements. Collective.
std::vector<Motions> rigidMotionsOf(const Substructures& all);

/// \param matrices, own  of the subdomains
/// \throws InputError, the same on all ranks, if near-kernels of one body differ in number or a body has no
/// subdomain. Collective.
BodyKernels findKernels(const Substructures& all, const std::vector<SubdomainMatrix>& matrices,
                        const std::vector<OwnSubdomain>& own);

} // namespace epafi::decomposition
