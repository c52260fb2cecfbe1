#pragma once

/// What an XML scene says, as plain validated values. Lengths, deflections, loads and conductivities share
/// one consistent system of units of the user's choice; nothing in Epafi depends on which.

#include "epafi/scene/Body.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace epafi::scene {

/// A rigid obstacle that does not move: a half-space, or a circle (in the plane) or sphere.
struct Obstacle {
  /// A circle is a sphere in the plane.
  enum class Kind { plane, sphere, cylinder };
  Kind kind = Kind::plane;
  Vector3 point{0, 0, 0};  ///< on the plane or axis; centre of the sphere
  Vector3 normal{0, 0, 1}; ///< of the plane towards the body, or along the axis, of length 1
  double radius = 1;       ///< of the sphere or cylinder
  bool isHollow = false;   ///< a bore or a cup, with the body inside
};

/// What tightens a bolt at a section of its shank, whose two sides a tied joint holds together: all of one
/// side is moved by the same length against all of the other, along the section's normal.
struct Preload {
  enum class Kind {
    force,      ///< the tension is given, and how far the sides move is found
    shortening, ///< the length is given that is taken out of the bolt
    locked      ///< the length is that which the load step before has come to
  };
  Kind kind = Kind::force;
  double value = 0; ///< force or length; not of Kind::locked

  /// Whether the length is known, and the force is not.
  [[nodiscard]] bool holdsLength() const { return kind != Kind::force; }
};

/// Contact of a body's surface with another body's or with an obstacle, or a joint of two bodies.
struct SurfaceContact {
  /// Contact: bodies do not penetrate. Tied: they are bonded, whatever lies between them.
  enum class Kind { contact, tied };
  /// How two surfaces are coupled: by pairs of nodes that face each other, by mortars, or as the meshes ask
  /// for.
  enum class Coupling { automatic, nodes, mortar };
  /// Which of two surfaces carries the multipliers.
  enum class Side { automatic, first, second };
  std::string name;
  int first = 0;            ///< index into Scene::bodies
  std::string firstSurface; ///< empty: all of a membrane, with an obstacle under or over it
  int second = -1;          ///< −1: the obstacle
  std::string secondSurface;
  Obstacle obstacle{};
  double gap = 0; ///< added to the gap that geometry leaves (membranes: all there is); negative: penetration
  /// Gaps of geometry up to this, overlaps too, count as none.
  double adjust = -std::numeric_limits<double>::infinity();
  std::string adjustNodes{}; ///< set of nodes of the first body of which gaps of geometry count as none, too
  /// Nodes farther from the other side than this get no inequality: they cannot meet.
  double distance = std::numeric_limits<double>::infinity();
  Kind kind = Kind::contact;
  Coupling coupling = Coupling::automatic;
  Side multipliers = Side::automatic;
  double friction = 0; ///< Coulomb's coefficient μ: tangential tractions are at most μ times the pressure
  double frictionBound = 0; ///< Tresca's: they are at most this, force per area
  double stiffness = 0;     ///< pressure over overclosure; 0: surfaces do not give way
  double stickSlope = 0;    ///< tangential traction over what sticking surfaces shift; 0: they do not
  bool isOn = true;         ///< false: it is as if it were not there
  std::optional<Preload> preload = std::nullopt; ///< of a tied joint
  /// The section's normal, out of the first body, of any length; nothing: the mean one of its surface.
  std::optional<Vector3> preloadDirection = std::nullopt;

  [[nodiscard]] bool hasFriction() const { return friction > 0 || frictionBound > 0; }
  /// Whether an obstacle may stop a membrane anywhere.
  [[nodiscard]] bool coversBody() const { return firstSurface.empty(); }
};

/// A linear equation between displacements of nodes, Σ factor · component = value, or a spring.
struct Equation {
  struct Term {
    double factor = 1;
    int body = 0;      ///< index into Scene::bodies
    std::string nodes; ///< surface or set of nodes of it, of one node
    int component = 0; ///< 0 to 2
  };
  std::string name;
  std::vector<Term> terms;
  double value = 0;
  double stiffness = 0; ///< of a spring, whose force is so many times what the sum is off; 0: it is not off
};

/// Holds a body at a node where it would be free to move: what it takes is a force there.
struct Hold {
  int body = 0;
  Point place{};       ///< of which the nearest node is meant
  Vector3 direction{}; ///< of length 1
  std::string motion;  ///< in words
};

struct Scene {
  std::string title;
  std::vector<Body> bodies;
  std::vector<SurfaceContact> contacts;
  std::vector<Equation> equations{};
  bool holdsFreeMotions = false; ///< rather than refuse them
  std::vector<Hold> holds{};     ///< found by that
};

} // namespace epafi::scene
