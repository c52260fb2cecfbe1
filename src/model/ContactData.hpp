#pragma once

/// What a scene says of its contacts beside their rows: by how much they give way, and their friction.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/scene/Scene.hpp"

#include <vector>

namespace epafi::model {

/// C of contacts that give way, on multiplierMap; null if none does. Rows that contacts share have the
/// springs of all side by side. Collective.
RCP<const Vector> complianceOf(const scene::Scene& scene, const std::vector<contact::ContactLayout>& contacts,
                               const decomposition::DecomposedProblem& problem);

/// Bounds and coefficients of friction; rows that contacts share have what these have, by their areas.
/// Collective.
void setFrictionData(const scene::Scene& scene, const std::vector<contact::ContactLayout>& contacts,
                     const decomposition::DecomposedProblem& problem, decomposition::ProblemData& data);

} // namespace epafi::model
