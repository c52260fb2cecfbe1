#pragma once

/// A body of any shape and physics, as plain validated values: membranes are solids of one component.
/// Lengths, forces and moduli share one consistent system of units of the user's choice (such as mm, N, MPa);
/// nothing in Epafi depends on which. Angles do not occur.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace epafi::scene {

/// membrane      −∇·(κ∇u) = f, one unknown a node
/// planeStrain   linear elasticity in the plane, no strain across it; two unknowns
/// planeStress   the same, no stress across it
/// elasticity3d  linear elasticity in space; three unknowns
enum class Physics { membrane, planeStrain, planeStress, elasticity3d };

/// "membrane", "plane strain", "plane stress", "elasticity 3-D".
std::string toString(Physics physics);

/// Unknowns a node: 1, 2, 2, 3.
int componentsOf(Physics physics);

/// Of what fills the body: 3 in space, else 2.
int dimensionOf(Physics physics);

using Vector3 = std::array<double, 3>; ///< x, y, z

/// Axis-parallel box; the whole space unless said otherwise. In the plane the third coordinate does not
/// matter.
struct Box {
  Vector3 lower{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                -std::numeric_limits<double>::infinity()};
  Vector3 upper{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                std::numeric_limits<double>::infinity()};
};

/// What a body or a region of it is made of; which numbers count follows from the physics.
struct Material {
  double conductivity = 1;    ///< κ of a membrane (its tension)
  double youngsModulus = 1;   ///< E > 0, force per area
  double poissonsRatio = 0.3; ///< ν, −1 < ν < ½
  double thickness = 1;       ///< of plane bodies
};

/// Another material in the elements whose centre lies in a box, or that belong to a group of the mesh file;
/// where several overlap, the last one in the file holds.
struct SolidRegion {
  std::string name;
  Box box;           ///< counts if `group` is empty
  std::string group; ///< physical group of the mesh file
  Material material;
};

/// Components of the displacement prescribed on a surface, or the displacement along its outward normal. One
/// alone makes a sliding support.
struct SolidSupport {
  std::string name;
  std::string surface; ///< "left" … "top" of a structured mesh, or a physical group
  std::array<std::optional<double>, 3> value;
  std::optional<double> normal = std::nullopt; ///< uᵀn, n the outward normal; the surface slides along itself
};

/// A load; loads add up.
struct SolidLoad {
  /// What the load acts on.
  enum class Kind {
    body, ///< force per volume (per area of a membrane) in the elements whose centre lies in a box or a group
    traction, ///< force per area on a surface
    pressure, ///< force per area against a surface's outward normal; value[0]
    point     ///< force at the node that lies at a point
  };
  std::string name;
  Kind kind = Kind::body;
  Box box;
  std::string where; ///< group (body; may be empty: the box counts) or surface
  Vector3 point{0, 0, 0};
  Vector3 value{0, 0, 0};
  /// Kind body with a box: elements carry the load as a whole or not at all. If false, on structured meshes
  /// exactly the part of the body that lies in the box does.
  bool wholeElements = true;
};

/// Where the elements come from: a structured box, or a file.
struct MeshSource {
  Box box;                              ///< of a structured mesh
  std::array<int, 3> elements{0, 0, 0}; ///< in x, y and z (z: 0 in the plane); of a structured mesh
  std::string file;                     ///< if not empty, a file that Gmsh reads, or several
  double sizeFactor = 1;                ///< by which all element sizes of a geometry (.geo) are multiplied
  int refinements = 0;                  ///< how often every element of the file is split
  int order = 1;                        ///< of the elements, 1 or 2; 0: as the mesh file has it
  std::string group; ///< the physical group in it that is this body; empty: all its elements
};

/// Whether the name of a mesh file stands for several, which hold a mesh by parts: "press_*.msh".
bool isSplit(const std::string& file);

/// How a body is cut into subdomains.
struct Decomposition {
  /// Along lines of the mesh, or by METIS on the graph of its elements.
  enum class Method { grid, metis };
  Method method = Method::grid;
  std::array<int, 3> counts = {2, 2, 2}; ///< grid: subdomains in x, y and, in space, z
  int parts = 0;                         ///< metis: number of parts; 0: as many as suit
  int cluster =
      -1; ///< subdomains that share crosspoints, one body's: so many; 0: all of it; -1: by their number
};

struct Body {
  std::string name;
  Physics physics = Physics::membrane;
  MeshSource mesh;
  Material material;
  std::vector<SolidRegion> regions;
  std::vector<SolidSupport> supports;
  std::vector<SolidLoad> loads;
  Decomposition decomposition;
};

/// Whether it is a membrane on a rectangle, whose surfaces are the four edges.
bool isMembraneOnRectangle(const Body& body);

/// [x0, x1] × [y0, y1], whatever z.
Box rectangle(double x0, double x1, double y0, double y1);

/// A membrane's load per area on exactly what lies in a box.
SolidLoad loadInside(std::string name, const Box& box, double value);

} // namespace epafi::scene
