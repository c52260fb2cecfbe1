#pragma once

/// The scenes of the scaling study, in any size.

#include "epafi/scene/Scene.hpp"

#include <string>

namespace epafi::drivers {

/// \param problem  "coercive" or "semicoercive": the paper's membranes; "blocks": two elastic cubes in space
/// one on the other, held at the lower and the upper end and pressed together on a half of their joint
/// \param counts    1/H: subdomains along a side of each body  \param elements  H/h
scene::Scene scalingScene(const std::string& problem, int counts, int elements);

} // namespace epafi::drivers
