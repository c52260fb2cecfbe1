#pragma once

/// The model problem of the paper: two unit membranes side by side, pressed together along their common edge.

#include "epafi/scene/Scene.hpp"

namespace epafi::scene {

/// Ω¹ = (0,1)², held on its left edge, and Ω² = (1,2) × (0,1), held on its right edge (coercive) or floating
/// (semicoercive); contact u² − u¹ ≥ 0 on x = 1. Loads: coercive −1 on (0,1) × (0.75,1) and −3 on (1,2) ×
/// (0,0.25); semicoercive −5 and −1 there.
/// \param counts    1/H: subdomains a side of each body, ≥ 1
/// \param elements  1/h: elements a side of each body, ≥ counts
Scene modelProblem(bool coercive, int counts, int elements);

} // namespace epafi::scene
