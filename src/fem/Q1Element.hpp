#pragma once

/// The bilinear rectangle: its stiffness and load, integrated exactly.

#include <Eigen/Core>

namespace epafi::fem {

/// ∫∇N_i·∇N_j over a rectangle of sides hx, hy (conductivity 1), nodes counter-clockwise from the lower left.
/// 4 × 4.
Eigen::Matrix4d membraneStiffness(double hx, double hy);

/// ∫N over the part of the segment [a, b] that lies in [low, high], for the two linear functions N of the
/// segment; exact, 0 if they do not meet.
Eigen::Vector2d segmentLoad(double a, double b, double low, double high);

/// ∫N_i over the part of an element that lies in a box: the product of the segments' along x and y. 4 values.
Eigen::Vector4d membraneLoad(const Eigen::Vector2d& alongX, const Eigen::Vector2d& alongY);

} // namespace epafi::fem
