#pragma once

/// What an XML scene says, as plain validated values. Lengths, deflections, loads and conductivities share
/// one consistent system of units of the user's choice; nothing in Epafi depends on which.

#include "epafi/scene/Solid.hpp"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace epafi::scene {

/// Axis-parallel rectangle [x0,x1] × [y0,y1], x0 < x1, y0 < y1.
struct Rectangle {
  double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
};

/// Of a rectangle.
enum class Edge { left, right, bottom, top };

/// "left", "right", "bottom" or "top".
std::string toString(Edge edge);

/// u = value along an edge of a body.
struct Support {
  std::string name;
  Edge edge = Edge::left;
  double value = 0;
};

/// Constant load (force per area) on the part of a body that lies in a rectangle; loads that overlap add up.
struct Load {
  std::string name;
  Rectangle box;
  double value = 0;
};

/// Conductivity of the elements whose centre lies in a rectangle; where several overlap, the last one in the
/// file holds.
struct Region {
  std::string name;
  Rectangle box;
  double conductivity = 1;
};

/// How a body is cut into subdomains.
struct Decomposition {
  /// Along lines of the mesh, or by METIS on the graph of its elements.
  enum class Method { grid, metis };
  Method method = Method::grid;
  std::array<int, 3> counts = {2, 2, 2}; ///< grid: subdomains in x, y and, in space, z
  int parts = 4;                         ///< metis: number of parts
};

/// A membrane −∇·(κ∇u) = f on a rectangle, Q1 elements; or, if `solid` is given, what that says.
struct Body {
  std::string name;
  Rectangle rectangle;
  std::array<int, 2> elements = {8, 8}; ///< in x and y
  double conductivity = 1;
  std::vector<Region> regions;
  std::vector<Support> supports;
  std::vector<Load> loads;
  Decomposition decomposition;
  std::optional<Solid> solid; ///< if there, name and decomposition are all that counts beside it
};

/// Non-penetration u_second − u_first ≥ −gap on a pair of coinciding edges; one inequality a node, end points
/// included.
struct ContactPair {
  std::string name;
  int first = 0; ///< index into Scene::bodies
  Edge firstEdge = Edge::right;
  int second = 0;
  Edge secondEdge = Edge::left;
  double gap = 0; ///< initial gap; negative means initial penetration
};

struct Scene {
  std::string title;
  std::vector<Body> bodies;
  std::vector<ContactPair> contacts;           ///< of membranes on rectangles
  std::vector<SurfaceContact> surfaceContacts; ///< of all others
};

} // namespace epafi::scene
