#pragma once

/// The kernels R^s of an application's bodies, from the near-kernels that it gave, or from rigid motions.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/decomposition/OwnSubdomain.hpp"
#include "epafi/decomposition/Pieces.hpp"
#include "epafi/decomposition/SubdomainMatrix.hpp"

#include <vector>

namespace epafi::decomposition {

/// Fills the kernels of the pieces, and kernelDimension and the bodies' motions of `problem`.
/// \param matrices, own  of the pieces
/// \throws InputError, the same on all ranks, if near-kernels of one body differ in number or a body has no subdomain.
/// Preconditions: the communicator, components and bodies of `problem` are set, the stiffness of the pieces is that of the free
/// unknowns. Collective.
void findKernels(const std::vector<SubdomainMatrix>& matrices, const std::vector<OwnSubdomain>& own,
                 int dimension, std::vector<Piece>& pieces, DecomposedProblem& problem);

} // namespace epafi::decomposition
