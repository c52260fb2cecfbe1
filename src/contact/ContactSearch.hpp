#pragma once

/// Which nodes of two surfaces, or of a surface and an obstacle, may meet, in which direction, and how far they are apart.
///
/// An obstacle's gap is the distance of a node from it, along its own normal, negative inside; nodes whose surface
/// faces away from it get none. Two surfaces match if every
/// node of one faces a node of the other along the normal, the mean of both surfaces' normals there; nodes that have no
/// counterpart are left out as long as the other surface is used up, such as beside a punch. Those that do not match meet by
/// mortars (MortarRows.hpp). Nodes farther from the other
/// side than the contact's `distance` get no row, and cost nothing.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/SurfaceNodes.hpp"

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace epafi::contact {

/// A rigid obstacle that does not move: a half-space, or a circle (in the plane) or sphere.
struct Obstacle {
  /// A circle is a sphere in the plane.
  enum class Kind { plane, sphere };
  Kind kind = Kind::plane;
  Eigen::Vector3d point{0, 0, 0};  ///< on the plane; centre of the sphere
  Eigen::Vector3d normal{0, 0, 1}; ///< of the plane, of length 1, towards the body
  double radius = 1;               ///< of the sphere
};

/// What a contact is to be, and its names for messages.
struct ContactTerms {
  std::string name;         ///< of the contact
  std::string firstSurface; ///< name of the first body's surface
  int dimension = 3;        ///< of space
  int components = 3; ///< unknowns a node; a single one is a deflection: gaps do not follow from geometry
  double gap = 0;     ///< added to that of geometry
  double distance = std::numeric_limits<double>::infinity(); ///< nodes farther from the other side get no row
  bool coincide = false; ///< the surfaces do, and their nodes meet in order
  double sense = 1;      ///< of a deflection: −1 if it is the second body that must stay below
};

/// The rows of nodes that an obstacle may stop; bodies and `firstRow` are left to the caller. \throws InputError if no node is
/// near enough, or the surface faces away. Not collective.
ContactLayout meetObstacle(const ContactTerms& contact, const SurfaceNodes& first, const Obstacle& obstacle);

/// For each node of a surface the place of the node of the other that it faces, or `alone`.
struct FacingNodes {
  static constexpr std::size_t alone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> partner;
};

/// Pairs of nodes, 𝒪(n log n). Not collective.
FacingNodes facingNodes(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second);

/// Whether pairs of nodes say all that is to be said: where the surfaces face each other, however far they are apart, nodes and
/// facets do so one by one.
bool areAlike(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second);

/// The rows of nodes that face each other; bodies and `firstRow` are left to the caller. \throws InputError if no node is near
/// enough, or the surfaces do not match. Not collective.
ContactLayout meetSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                          const FacingNodes& pairs);

/// Those that tie them, `components` for each pair, along axes (columns); likewise.
ContactLayout tieSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                         const FacingNodes& pairs, const Eigen::Matrix3d& axes);

} // namespace epafi::contact
