#pragma once

/// The bilinear rectangle: its stiffness and load, integrated exactly.

#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

namespace epafi::fem {

/// ∫∇N_i·∇N_j over a rectangle of sides hx, hy (conductivity 1), nodes counter-clockwise from the lower left.
/// 4 × 4.
Eigen::Matrix4d membraneStiffness(double hx, double hy);

/// ∫N_i over the part of the element that lies in `box`, exact for any box. 4 values; 0 if they do not meet.
Eigen::Vector4d membraneLoad(const scene::Rectangle& element, const scene::Rectangle& box);

} // namespace epafi::fem
