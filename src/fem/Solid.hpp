#pragma once

/// What a body is made of, held by and loaded with, as plain validated values: membranes are solids of one
/// component. Lengths, forces and moduli share one consistent system of units of the user's choice (such as
/// mm, N, MPa); nothing in Epafi depends on which. Angles do not occur.

#include "epafi/mesh/Box.hpp"

#include <Eigen/Core>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace epafi::fem {

/// membrane      −∇·(κ∇u) = f, one unknown a node
/// planeStrain   linear elasticity in the plane, no strain across it; two unknowns
/// planeStress   the same, no stress across it
/// elasticity3d  linear elasticity in space; three unknowns
/// axisymmetric  the same of a solid of revolution about the y-axis, of which half a section is meshed, x ≥ 0
///               being the radius: displacements along x and y alone; two unknowns. Forces, areas and
///               energies are those of the whole circumference
enum class Physics { membrane, planeStrain, planeStress, elasticity3d, axisymmetric };

/// "membrane", "plane strain", "plane stress", "elasticity 3-D", "axisymmetric".
std::string toString(Physics physics);

/// Unknowns a node: 1, 2, 2, 3, 2.
int componentsOf(Physics physics);

/// Of what fills the body: 3 in space, else 2.
int dimensionOf(Physics physics);

/// C of any linear elastic law, σ = Cε, in the order xx, yy, zz, xy, yz, zx, shear strains being angles:
/// ε_xy = ∂u/∂y + ∂v/∂x. Symmetric, positive definite, force per area.
using ElasticityMatrix = Eigen::Matrix<double, 6, 6>;

/// What a body or a region of it is made of; which numbers count follows from the physics.
struct Material {
  double conductivity = 1;    ///< κ of a membrane (its tension)
  double youngsModulus = 1;   ///< E > 0, force per area
  double poissonsRatio = 0.3; ///< ν, −1 < ν < ½
  double thickness = 1;       ///< of plane bodies
  double expansion = 0;       ///< α of elastic bodies: strain, the same in all directions, per degree
  /// Of a body that is not isotropic, instead of E and ν.
  std::optional<ElasticityMatrix> elasticity = std::nullopt;
};

/// Another material in the elements whose centre lies in a box, or that belong to a group of the mesh file;
/// where several overlap, the last one in the file holds.
struct SolidRegion {
  std::string name;
  mesh::Box box;     ///< counts if `group` is empty
  std::string group; ///< physical group of the mesh file
  Material material;
  bool mayBeEmpty = false; ///< that no element has its centre in the box is no fault, but of a coarse mesh
};

/// Axes that displacements are given along, perpendicular to each other, at every point.
struct LocalAxes {
  bool isCylindrical = false;
  /// The first axis, and a direction in the plane of the first two; cylindrical: two points of the line that
  /// the second axis turns about and the third lies along, while the first leads away from it.
  Vector3 a{1, 0, 0}, b{0, 1, 0};
};

/// The axes at a point, columns of a rotation. Precondition: a and b are not parallel, or not one point; on
/// the line itself the first axis is any that is perpendicular to it.
Eigen::Matrix3d axesAt(const LocalAxes& axes, const Point& point);

/// Components of the displacement prescribed on a surface or a set of nodes, or the displacement along the
/// surface's outward normal. One alone makes a sliding support.
struct SolidSupport {
  std::string name;
  std::string surface; ///< "left" … "top" of a structured mesh, or a physical group
  std::array<std::optional<double>, 3> value;
  std::optional<double> normal = std::nullopt; ///< uᵀn, n the outward normal; the surface slides along itself
  std::optional<LocalAxes> axes = std::nullopt; ///< those of the components; nothing: those of space
  /// Of its nodes, in space: what the support holds them at, instead of its values.
  std::optional<std::map<GlobalOrdinal, Vector3>> displacements = std::nullopt;
};

/// By what all elastic constants are multiplied at nodes, of a stiffness that varies inside a body. Between
/// nodes it is interpolated as displacements are; at a node that several name the last one holds, at one that
/// none names it is 1.
struct StiffnessFactor {
  std::string name;
  std::string where; ///< surface or set of nodes
  double value = 1;  ///< > 0
};

/// A load; loads add up.
struct SolidLoad {
  /// What the load acts on.
  enum class Kind {
    body, ///< force per volume (per area of a membrane) in the elements whose centre lies in a box or a group
    traction,    ///< force per area on a surface
    pressure,    ///< force per area against a surface's outward normal; value[0]
    point,       ///< force at the node that lies at a point, or at each node of a surface or set of nodes
    distributed, ///< force `value` and moment on a surface, as a traction that is linear in place
    rotation, ///< force per volume away from an axis, in the elements of a group: value[0] times the distance
    temperature ///< change by value[0] at each node of a surface or set of nodes, or of the whole body
  };
  std::string name;
  Kind kind = Kind::body;
  mesh::Box box;
  std::string where;      ///< group (body, rotation; may be empty: the box counts), surface or set of nodes
  Vector3 point{0, 0, 0}; ///< where the node lies, or a distributed force acts, or on the axis of rotation
  Vector3 value{0, 0, 0};
  /// Kind body with a box: elements carry the load as a whole or not at all. If false, on structured meshes
  /// exactly the part of the body that lies in the box does.
  bool wholeElements = true;
  Vector3 axis{0, 0, 1};   ///< of rotation, of any length but 0
  Vector3 moment{0, 0, 0}; ///< kind distributed: about the point; in the plane along z
  bool atCentre = true;    ///< kind distributed: the point is the surface's centre
};

/// All that assembly asks of a body beside its mesh.
struct Solid {
  std::string name;
  Physics physics = Physics::membrane;
  Material material;
  std::vector<SolidRegion> regions;
  std::vector<SolidSupport> supports;
  std::vector<SolidLoad> loads;
  std::vector<StiffnessFactor> stiffnessFactors; ///< of elastic bodies
  bool reducedIntegration = false;               ///< of elements by Shape's reducedSamples
  bool holdsAxis = true; ///< whether nodes of a solid of revolution that lie on its axis stay there
};

/// Whether its temperature changes anywhere.
bool isHeated(const Solid& body);

/// Whether it is of one material everywhere.
inline bool isUniform(const Solid& body) {
  return body.regions.empty() && body.stiffnessFactors.empty();
}

/// A membrane's load per area on exactly what lies in a box.
SolidLoad loadInside(std::string name, const mesh::Box& box, double value);

} // namespace epafi::fem
