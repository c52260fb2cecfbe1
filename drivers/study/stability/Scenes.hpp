#pragma once

/// The bodies that the cases are made of, all about as large as 1.

#include "epafi/scene/Scene.hpp"

#include <array>
#include <string>

namespace epafi::drivers {

scene::Decomposition grid(std::array<int, 3> counts);
scene::Decomposition metis(int parts);

/// Cuts every body alike.
scene::Scene cut(scene::Scene scene, const scene::Decomposition& how);

/// The two membranes of the paper, 1/H = `subdomains`, H/h = `elements`.
scene::Scene membranes(bool coercive, int subdomains, int elements);

/// Two unit membranes side by side under loads that are constant on each, −u₁'' = f₁, −u₂'' = f₂, the first one held on
/// its left, the second one on its right unless it floats. Coercive, without gap: u₁(1) = f₁/2 − λ, u₂(1) = f₂/2 + λ,
/// λ = max(0, (f₁ − f₂)/4) per length, whatever the mesh.
scene::Scene strips(bool coercive, double first, double second, int elements = 4);

/// A block of E = 200, ν = 0.3 (in the plane: elements[2] = 0, plane strain).
scene::Body block(const std::string& name, const scene::Box& box, std::array<int, 3> elements,
                  const scene::Decomposition& how);
/// All components of the displacement are 0 there.
scene::SolidSupport clamp(const std::string& surface);
/// Along the outward normal it is `normal`; the surface slides.
scene::SolidSupport slide(const std::string& surface, double normal = 0);
scene::SolidLoad weight(const scene::Vector3& force);
scene::SolidLoad pointForce(const scene::Vector3& point, const scene::Vector3& force);
scene::SurfaceContact onPlane(const std::string& name, int body, const std::string& surface,
                              const scene::Vector3& point, const scene::Vector3& normal, double gap = 0);
scene::SurfaceContact between(const std::string& name, int first, const std::string& firstSurface, int second,
                              const std::string& secondSurface, double gap = 0);

/// A unit square that hangs from its top, pressed down onto a second one that is clamped at its bottom: E = 200. Cut
/// into n × n subdomains of m × m elements each.
scene::Scene pressedSquares(int subdomains, int elements);
/// Two cubes likewise.
scene::Scene pressedCubes(int subdomains, int elements);
/// A unit square that stands on a plane between a sliding wall on its left and nothing, under its weight.
scene::Scene standingSquare(int subdomains, int elements);

} // namespace epafi::drivers
