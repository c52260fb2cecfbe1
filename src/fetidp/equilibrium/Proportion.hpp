#pragma once

/// Whether a solution can be one of the problem that is meant: gaps are linear in the displacements.

#include "epafi/base/Types.hpp"
#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"

namespace epafi::fetidp {

/// \throws SolvabilityError (not unique), the same on all ranks, if a floating body whose motions are known
/// (Body::motions), and which meets surfaces whose normals are not (ContactPlace::Side::uncertainty), moves
/// almost rigidly by more than its size, and a hundred times farther than anything is deformed or gaps are
/// wide that closed: something hinders it that does not hold it.
/// \param u       unknowns of this rank's subdomains
/// \param lambda  forces: gaps closed where they are positive
/// Collective.
void requireProportion(const decomposition::DecomposedProblem& problem,
                       const decomposition::ProblemData& data, const SubdomainVectors& u,
                       const Vector& lambda);

} // namespace epafi::fetidp
