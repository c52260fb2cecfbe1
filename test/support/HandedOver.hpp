#pragma once

/// Scenes handed over as an application would do it: subdomain matrices with global numbers, contact rows as
/// a matrix.

#include "epafi/decomposition/UnassembledProblem.hpp"
#include "epafi/model/Decompose.hpp"

#include <memory>
#include <vector>

namespace epafi::decomposition {

/// What becomes of supported unknowns.
enum class Supports {
  eliminated, ///< they are no unknowns of the application
  prescribed  ///< K^s has rows for them, and their values are given
};

/// The subdomains of a scene on the ranks on which `decompose` puts them. Precondition: no supports with axes
/// of their own. Collective.
std::vector<SubdomainMatrix> matricesOf(const scene::Scene& scene, Supports supports);
/// A problem of these subdomains and the bodies of the scene, not complete and without contact. Collective.
std::unique_ptr<UnassembledProblem> handOver(const scene::Scene& scene,
                                             std::vector<SubdomainMatrix> matrices);

/// Global number of a body's first node, in that problem: bodies follow each other.
std::vector<GlobalOrdinal> firstNodes(const model::Decomposition& decomposition);

/// The contact rows of a decomposed scene as a matrix over all unknowns, distributed evenly. \param supports
/// eliminated: no entries where there is no unknown, and gaps take account of it. Collective.
ConstraintMatrix contactOf(const scene::Scene& scene, const model::Decomposition& decomposition,
                           Supports supports);

} // namespace epafi::decomposition
