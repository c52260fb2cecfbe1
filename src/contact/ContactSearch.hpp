#pragma once

/// Which nodes of two surfaces, or of a surface and an obstacle, may meet, in which direction, and how far
/// they are apart.
///
/// An obstacle's gap is the distance of a node from it, along its own normal, negative inside; nodes whose
/// surface faces away from it get none. Two surfaces match if every node of one faces a node of the other
/// along the normal, the mean of both surfaces' normals there; nodes that have no counterpart are left out as
/// long as the other surface is used up, such as beside a punch. A row's area is its share of the facets that
/// both surfaces have in common. Where a surface bends sharply, normal and area are those of the faces that
/// face the other side best. Those that do not match meet by mortars (MortarRows.hpp). Nodes farther from the
/// other side than the contact's `distance` get no row, and cost nothing.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactTerms.hpp"
#include "epafi/contact/FacingNodes.hpp"
#include "epafi/contact/SurfaceNodes.hpp"

#include <Eigen/Core>

namespace epafi::contact {

/// A rigid obstacle that does not move: a half-space, or a circle (in the plane), sphere or cylinder, outside
/// or inside of which bodies are.
struct Obstacle {
  /// A circle is a sphere in the plane.
  enum class Kind { plane, sphere, cylinder };
  Kind kind = Kind::plane;
  Eigen::Vector3d point{0, 0, 0};  ///< on the plane or axis; centre of the sphere
  Eigen::Vector3d normal{0, 0, 1}; ///< of the plane towards the body, or along the axis, of length 1
  double radius = 1;               ///< of the sphere or cylinder
  bool isHollow = false;           ///< a bore or a cup, with the body inside
};

/// The rows of nodes that an obstacle may stop; bodies and `firstRow` are left to the caller. \throws
/// InputError if no node is near enough, or the surface faces away. Not collective.
ContactLayout meetObstacle(const ContactTerms& contact, const SurfaceNodes& first, const Obstacle& obstacle);

/// The rows of nodes that face each other; bodies and `firstRow` are left to the caller. \throws InputError
/// if no node is near enough, or the surfaces do not match. Not collective.
ContactLayout meetSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                          const FacingNodes& pairs);

/// Those that tie them, `components` for each pair, along axes (columns); likewise.
ContactLayout tieSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                         const FacingNodes& pairs, const Eigen::Matrix3d& axes);

} // namespace epafi::contact
