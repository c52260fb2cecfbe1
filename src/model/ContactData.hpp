#pragma once

/// What a scene says of its contacts beside their rows: by how much they give way, and their friction.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/scene/Scene.hpp"

#include <vector>

namespace epafi::model {

/// Row of the first equation, behind those of ties.
GlobalOrdinal firstEquation(const std::vector<contact::ContactLayout>& ties,
                            const decomposition::DecomposedProblem& problem);

/// C of contacts and ties that give way and of springs, on multiplierMap; null if there are none. Rows that
/// contacts share have the springs of all side by side. Collective.
RCP<const Vector> complianceOf(const scene::Scene& scene, const std::vector<contact::ContactLayout>& contacts,
                               const std::vector<contact::ContactLayout>& ties,
                               const std::vector<contact::Equation>& equations,
                               const decomposition::DecomposedProblem& problem);

/// Bounds and coefficients of friction; rows that contacts share have what these have, by their areas.
/// Collective.
void setFrictionData(const scene::Scene& scene, const std::vector<contact::ContactLayout>& contacts,
                     const decomposition::DecomposedProblem& problem, decomposition::ProblemData& data);

} // namespace epafi::model
