#pragma once

/// Equations between displacements, as a scene's list gives them.

#include "epafi/scene/ListReader.hpp"

namespace epafi::scene {

/// Appends the list's equations to those of the scene, whose bodies are known. \throws InputError if a term
/// is not of the form "factor body/nodes/component", names no body, or an axis that its unknowns do not have.
void readEquations(const ListReader& list, Scene& scene);

} // namespace epafi::scene
