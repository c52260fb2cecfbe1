#pragma once

/// What a STEP file describes, as plain values: solids, their faces, and which of these lie close together.
/// Lengths are millimetres, whatever the file has.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Box.hpp"

#include <string>
#include <vector>

namespace epafi::assembly {

struct Face {
  int number = 0;   ///< of a STEP file Gmsh's
  int solid = 0;    ///< index into Assembly::solids
  std::string kind; ///< plane, cylinder, cone, sphere, torus or surface
  double area = 0;
  Point centre{};      ///< of area
  Vector3 axis{};      ///< the outward normal of a plane, the direction of a cylinder's axis; 0 otherwise
  Point onAxis{};      ///< a point of a cylinder's axis, a sphere's centre
  double radius = 0;   ///< of cylinders and spheres
  std::string group{}; ///< what the mesh calls it
};

/// A corner of solids, where edges meet, or a round one begins; the mesh has the group "point 3".
struct Corner {
  int number = 0;
  int solid = 0;
  Point place{};
};

struct Solid {
  std::string name; ///< that of the instance in the file
  double volume = 0;
  mesh::Box box;
};

/// Faces of two solids that face each other.
struct FacePair {
  int first = 0, second = 0; ///< indices into Assembly::faces; the first is the smaller
  double area = 0;           ///< of the first, as far as it is near
  /// Distances where they are near, overlaps negative; of a near miss twice the least.
  double leastGap = 0, largestGap = 0;
  Point closest{}; ///< where the least is, on either
  double sag = 0;  ///< by how much facets are off the smooth surfaces there, if they were looked at
};

struct Assembly {
  std::string unit; ///< of a STEP file
  std::vector<Solid> solids;
  std::vector<Face> faces;
  std::vector<Corner> corners;
  std::vector<FacePair> pairs, nearMisses;

  [[nodiscard]] mesh::Box box() const;
  [[nodiscard]] double diagonal() const; ///< of the box
};

/// Values in words, and back.
std::string textOf(const Assembly& assembly);
Assembly assemblyFrom(const std::string& text);

} // namespace epafi::assembly
