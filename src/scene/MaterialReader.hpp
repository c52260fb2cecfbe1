#pragma once

/// What bodies and their regions are made of, from a scene's file.

#include "epafi/fem/Solid.hpp"
#include "epafi/scene/ListReader.hpp"

#include <vector>

namespace epafi::scene {

/// What is not given is as in `outer`. Of a region nothing is required. \throws InputError
fem::Material readMaterial(const ListReader& list, fem::Physics physics, const fem::Material& outer,
                           bool isRegion);

/// What the list of a body's stiffness factors says. \throws InputError if a membrane has any
std::vector<fem::StiffnessFactor> readStiffnessFactors(const ListReader& list, fem::Physics physics);

} // namespace epafi::scene
