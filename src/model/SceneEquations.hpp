#pragma once

/// The equations of a scene over nodes of its meshes.

#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/scene/Scene.hpp"

#include <memory>
#include <vector>

namespace epafi::model {

/// Node of each of Scene::holds. Collective.
std::vector<GlobalOrdinal> heldNodes(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                                     const Comm& comm);

/// Those of the scene, and those of its holds, that supports do not fix altogether. Not collective (every
/// rank finds the same). \throws InputError if a term's nodes are not there, or not one; SolvabilityError if
/// supports hold all of an equation's displacements, at values that contradict it.
/// \param held  heldNodes()
std::vector<contact::Equation> equationsOf(const scene::Scene& scene,
                                           const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                                           const std::vector<GlobalOrdinal>& held);

/// Whether supports prescribe all of an equation. \throws SolvabilityError if they contradict one that is no
/// spring
bool isFixed(const contact::Equation& equation, const std::vector<std::unique_ptr<fem::BodyModel>>& models);

} // namespace epafi::model
