#include "epafi/scene/SceneSchema.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/scene/ContactSchema.hpp"
#include "epafi/scene/EdgeContact.hpp"
#include "epafi/scene/Scene.hpp"

#include <Teuchos_Array.hpp>

#include <limits>

namespace epafi::scene {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

const std::vector<std::string> edgeNames(edges.begin(), edges.end());
/// What the arrays may hold, for the reference; ListReader checks it.
const std::string box = "x0 < x1, y0 < y1, z0 < z1", counts = "each ≥ 1";
constexpr double infinity = std::numeric_limits<double>::infinity();
/// Of the elements, unless the scene says otherwise: on every scene of docs/accuracy.md order 2 is sooner at
/// an error that one would want.
constexpr int bestOrder = 2;

void describeMaterial(ParameterList& list, const std::string& of) {
  const fem::Material material;
  addReal(list, "Conductivity", material.conductivity, "Membranes: conductivity (tension) " + of + '.', 0.0,
          infinity, true);
  addReal(list, "Young's Modulus", material.youngsModulus,
          "Elastic bodies, required if isotropic: E " + of + ", force per area.", 0.0, infinity, true);
  addReal(list, "Poisson's Ratio", material.poissonsRatio,
          "Elastic bodies, required if isotropic: ν " + of + '.', -1.0, 0.5, true, true);
  addArray(
      list, "Elasticity", Array<double>(),
      "Elastic bodies that are not isotropic, instead of Young's Modulus and Poisson's Ratio: constants " +
          of +
          ", force per area, of σ = Dε with shear strains as angles. 9 of an orthotropic material, {D1111, "
          "D1122, "
          "D2222, D1133, D2233, D3333, D1212, D1313, D2323}, or 21 of any, {D1111, D1122, D2222, D1133, "
          "D2233, "
          "D3333, D1112, D2212, D3312, D1212, D1113, D2213, D3313, D1213, D1313, D1123, D2223, D3323, D1223, "
          "D1323, D2323}. Plane bodies take what they need: in plane stress no stress acts across the plane.",
      "D is positive definite");
  addArray(list, "Axes", Array<double>(),
           "With Elasticity: two vectors {ax, ay, az, bx, by, bz}. Its axis 1 is along a, its axis 2 in the "
           "plane of "
           "a and b, on the side of b. {}: the axes of space.",
           "");
  addReal(list, "Thickness", material.thickness, "Plane strain and plane stress: thickness " + of + '.', 0.0,
          infinity, true);
  addReal(list, "Expansion", material.expansion,
          "Elastic bodies: α " + of +
              ", strain in all directions per degree, for loads of the kind temperature.");
}

void describeMesh(ParameterList& list) {
  addArray(list, "Rectangle", Array<double>(),
           "Extent {x0, x1, y0, y1} of a body in the plane; required unless it has a mesh file.", box);
  addArray(list, "Box", Array<double>(),
           "Extent {x0, x1, y0, y1, z0, z1} of a body in space; required unless it has a mesh file. Its "
           "surfaces are left and right (x), front and back (y), bottom and top (z).",
           box);
  addArray(
      list, "Elements", Array<int>(),
      "Number of elements {nx, ny} in x and y, in space {nx, ny, nz}; required unless there is a mesh file.",
      counts);
  list.set(
      "Mesh", "",
      "A file of Gmsh (.msh 2.2 or 4.1, or .geo, which is meshed then) or a STEP file instead; relative to "
      "the scene's directory. Triangles and quadrilaterals, tetrahedra, hexahedra, prisms and pyramids, one "
      "or several "
      "of them in a body, linear or quadratic. A name with "
      "* (press_*.msh) "
      "stands for the files that Gmsh saves of a partitioned mesh (gmsh -part 64 -part_split); ranks "
      "read them side by side.");
  addInteger(
      list, "Order", bestOrder,
      "Order of the elements: linear or quadratic. Of a mesh file (.msh) its own order counts if none is "
      "given; quadratic elements of a geometry (.geo) are curved where it is.",
      1, 2);
  addChoice(list, "Inner Nodes", "added",
            "With a mesh file: what becomes of quadratic quadrilaterals and hexahedra without nodes in the "
            "middle of "
            "faces and of themselves (8 and 20 nodes). added: they get them (9 and 27 nodes), and keep their "
            "form; none: "
            "they stay as they are.",
            {"added", "none"});
  addReal(list, "Mesh Size Factor", meshing::MeshSource().sizeFactor,
          "With a .geo or STEP file: by which all its mesh sizes are multiplied; 0.5 halves the elements.",
          0.0, infinity, true);
  addInteger(list, "Elements Around", meshing::StepSizes().elementsAround,
             "With a STEP file: how many elements go around a circle, before the factor.", 4, 1000);
  addArray(
      list, "Fine Points", Array<double>(),
      "With a STEP file: {x, y, z, size, ...}, points and the size of elements there, which grows by half "
      "the distance.",
      "size > 0");
  addInteger(
      list, "Mesh Refinements", meshing::MeshSource().refinements,
      "With a mesh file: how many times every element is split, into 4 in the plane and into 8 in space.", 0,
      8);
  list.set("Group", "",
           "Physical group of the mesh file that is this body; without it all elements. Surfaces are the "
           "physical groups of one dimension less.");
}

void describeRegions(ParameterList& body) {
  ParameterList& region =
      body.sublist("Regions", false, "Parts of the body of another material.")
          .sublist("<region>", false,
                   "Elements in a box or of a group. Where regions overlap, the last one in the file holds; "
                   "what is not given here is as in the body.");
  addArray(region, "Box", Array<double>(),
           "Extent {x0, x1, y0, y1}, in space {x0, x1, y0, y1, z0, z1}; the region are the elements whose "
           "centre lies in it. Required unless there is a group.",
           box);
  region.set("Group", "", "Physical group of the mesh file.");
  describeMaterial(region, "of these elements");
}

void describeSupports(ParameterList& body) {
  ParameterList& support =
      body.sublist("Supports", false, "Where deflection or displacement is prescribed.")
          .sublist("<support>", false,
                   "One supported edge or surface. Of an elastic body those components "
                   "are held that are given: one alone, or the normal, makes a sliding support.");
  addChoice(support, "Edge", "", "Membranes on rectangles, required: the supported edge.", edgeNames);
  support.set(
      "Surface", "",
      "All other bodies, required: the supported surface; of a mesh file also a group of points or, in "
      "space, of curves.");
  addReal(support, "Value", 0.0, "Membranes: deflection along it.");
  addReal(support, "X", 0.0, "Elastic bodies: displacement in x; free if not given.");
  addReal(support, "Y", 0.0, "Elastic bodies: displacement in y; free if not given.");
  addReal(support, "Z", 0.0, "Elastic bodies in space: displacement in z; free if not given.");
  addArray(support, "Axes", Array<double>(),
           "Elastic bodies: the axes of X, Y and Z, unless they are those of space: {x, y, z, x, y, z}, two "
           "vectors, X along the first, Y in the plane of both.",
           "");
  addArray(
      support, "Cylinder", Array<double>(),
      "Elastic bodies, instead of Axes: two points of a line, {x, y, z, x, y, z}; X leads away from it, Y "
      "around it, Z along it.",
      "");
  addReal(
      support, "Normal", 0.0,
      "Elastic bodies: displacement along the surface's outward normal; the surface slides along itself.");
}

void describeFactors(ParameterList& body) {
  ParameterList& factor =
      body.sublist("Stiffness Factors", false,
                   "Elastic bodies whose stiffness varies inside, as with the temperature.")
          .sublist(
              "<factor>", false,
              "By what the elastic constants are multiplied at some nodes; in between it is interpolated as "
              "displacements are. Of several that name a node the last one holds; where none does it is 1.");
  factor.set("Surface", "", "A surface of the body, or a group of points, curves or nodes of its mesh file.");
  setRequired(factor, {"Surface"});
  addReal(factor, "Value", 1.0, "The factor.", 0.0, infinity, true);
}

void describeLoads(ParameterList& body) {
  ParameterList& load =
      body.sublist("Loads", false, "Forces on the body, and changes of its temperature; loads add up.")
          .sublist("<load>", false, "One load, constant in space.");
  addChoice(
      load, "Kind", "body",
      "body: force per volume (per area of a membrane) in the elements of a box or group; traction: force "
      "per area on a surface (per length on a membrane's); pressure: force per area against a surface's "
      "outward normal; distributed: a force and a moment on a surface, spread over it linearly in place; "
      "point: force at a node, or at each of a group; rotation: force per volume away from "
      "an "
      "axis, Value times the distance, in the elements of a group: ρω² of a body that turns; temperature: "
      "its change, by which the body expands, "
      "at each node of a group or of the whole body.",
      {"body", "traction", "pressure", "distributed", "point", "rotation", "temperature"});
  addArray(load, "Box", Array<double>(),
           "Kind body: extent {x0, x1, y0, y1}, in space {x0, x1, y0, y1, z0, z1}, of what carries the load: "
           "that part of a "
           "membrane, of an elastic body the elements whose centre lies in it. {} is the whole body.",
           box);
  load.set("Group", "", "Kinds body and rotation: physical group of the mesh file that carries the load.");
  load.set("Surface", "",
           "Kinds traction, pressure and distributed, required: the loaded surface. Kind point: a surface, "
           "or a group of "
           "points "
           "or curves, at each of whose nodes the force is. Kind temperature: likewise the nodes that become "
           "warmer; without it all.");
  addArray(
      load, "Point", Array<double>(),
      "Kind point, unless there is a Surface: where the node lies, {x, y} or {x, y, z}. Kind rotation: a "
      "point of the axis, unless it is the origin; axisymmetric bodies turn about x = 0. Kind distributed: "
      "where the force acts, perhaps far from the surface; without it at the surface's centre.",
      "");
  addArray(load, "Axis", Array<double>(), "Kind rotation in space, required: direction of the axis.", "");
  addReal(
      load, "Value", 0.0,
      "Membranes, required: force, positive upwards. Kind pressure, required: the pressure. Kind rotation, "
      "required: force per volume and distance. Kind temperature, required: the change in degrees.");
  addArray(
      load, "Force", Array<double>(),
      "Elastic bodies, required but for pressure, rotation and temperature: components {x, y} or {x, y, "
      "z} of the force. Kind point and distributed of axisymmetric bodies: that of the whole circumference.",
      "");
  addArray(load, "Moment", Array<double>(),
           "Kind distributed: {x, y, z}, in the plane {m}, beside the force at its Point.", "");
}

void describeBody(ParameterList& bodies) {
  ParameterList& list = bodies.sublist("<body>", false, "One body, under a name of your choice.");
  addChoice(
      list, "Physics", "membrane",
      "What the body is: a membrane, −∇·(κ∇u) = f, or linearly elastic. All bodies of a scene have the same "
      "number of unknowns a node. axisymmetric: a solid of revolution about the y-axis, of which half a "
      "section is meshed, x >= 0 being the radius; all bodies of a scene, then. Forces at points and of "
      "contacts are those of the whole circumference, tractions and pressures forces per area as ever.",
      {"membrane", "plane strain", "plane stress", "elasticity 3-D", "axisymmetric"});
  describeMesh(list);
  addChoice(
      list, "Integration", "full",
      "By how many points elements are integrated. reduced: by two along each axis, as others do (C3D20R, "
      "CPS8R), "
      "of elastic bodies of quadrilaterals of 8 and hexahedra of 20 nodes; of prisms of 6 nodes by 2 points, "
      "of 15 by 9 (C3D6, C3D15); of others fully. Such elements lock less and "
      "cost "
      "less, but are less reliable: single ones have motions without energy. A body, and a part of it, is "
      "refused "
      "in which an element has no neighbours along two of its axes (in the plane along one, a prism at a "
      "side); "
      "near loads at "
      "points "
      "and in coarse meshes displacements may waver all the same, and refining need not bring an error down "
      "steadily.",
      {"full", "reduced"});
  addChoice(
      list, "Axis", "held",
      "Axisymmetric bodies: whether nodes at x = 0 stay there, as they have to. free: unless a support holds "
      "them they may leave the axis a little, as integration by points beside it lets them; so decks mean "
      "it.",
      {"held", "free"});
  describeMaterial(list, "of the body outside of its regions");
  describeRegions(list);
  describeFactors(list);
  describeSupports(list);
  describeLoads(list);
  list.sublist("Decomposition", false,
               "How this body is cut; what is not given here holds as the scene's Decomposition says.")
      .setParameters(decompositionSchema());
}

} // namespace

ParameterList decompositionSchema() {
  const Decomposition cut;
  ParameterList list("Decomposition");
  addChoice(list, "Method", "grid",
            "A grid of rectangles or boxes (structured meshes), or METIS on the graph of the elements. "
            "Bodies with a "
            "mesh file are cut by METIS unless told otherwise.",
            {"grid", "metis"});
  addArray(
      list, "Grid", Array<int>(cut.counts.begin(), cut.counts.begin() + 2),
      "With the method grid: number of subdomains {nx, ny} in x and y of each body, in space {nx, ny, nz} "
      "(if not given {2, 2, 2}, or as many as there are elements).",
      counts);
  addInteger(
      list, "Parts", cut.parts,
      "With the method metis: number of subdomains of each body; 0: one for every 4000 unknowns in the "
      "plane, for every 1000 in space. Of a mesh in several files each is cut by itself, into one part at "
      "least.",
      0);
  addInteger(
      list, "Cluster", cut.cluster,
      "How many subdomains of a body share crosspoints. 0: all of it (FETI-DP, one coarse problem); 1: "
      "none (FETI, a coarse space of rigid motions); else so many neighbours (hybrid), best those of a "
      "rank. -1: 0, but for grids of so many subdomains on so many ranks that hybrid takes less time.",
      -1);
  return list;
}

void describeStep(ParameterList& steps) {
  ParameterList& step =
      steps.sublist("<step>", false,
                    "What changes in a step; what it does not name stays as the step before had "
                    "it, or the scene.");
  step.set("Loads", "", "By what loads are multiplied: \"body/load = factor\", several parted by commas.");
  step.set(
      "Supports", "",
      "By what the displacements are multiplied that supports prescribe: \"body/support = factor\", …; off: "
      "it does not hold; fixed: it holds its nodes where the step before has moved them.");
  step.set("Contacts", "", "Whether contacts and tied joints count: \"contact = off\", \"contact = on\", …");
  step.set("Gaps", "", "Gap of contacts: \"contact = gap\", …");
  step.set("Friction", "", "Coefficient of contacts that have Friction: \"contact = coefficient\", …");
  step.set(
      "Preload", "",
      "Of tied joints that have a Preload: \"joint = force 100\", \"joint = shortening 0.1\", or \"joint = "
      "locked\" at the length of the step before.");
}

ParameterList sceneSchema() {
  ParameterList list("Epafi");
  list.set("Title", "", "What the scene shows, in a few words.");
  addChoice(
      list, "Free Motions", "refuse",
      "What becomes of motions of bodies that no support and no smooth surface in contact hinders, as of "
      "a pin about its axis. refuse: they are named, and nothing is solved. hold: each is held at one "
      "node, and the force that this takes is told.",
      {"refuse", "hold"});
  describeBody(list.sublist("Bodies", false,
                            "The bodies, at least one. Lengths, forces and moduli are in one consistent "
                            "system of units of your choice "
                            "(mm, N and MPa, say); results are in the same. Real numbers in a scene are 0 or "
                            "between 1e-30 and 1e30 in "
                            "magnitude."));
  describeObstacle(list.sublist("Obstacles", false, "Rigid obstacles that bodies may meet."));
  describePair(list.sublist("Contact", false, "What cannot penetrate each other, or is tied."));
  ParameterList& equation =
      list.sublist("Equations", false, "Linear equations between displacements of nodes of elastic bodies.")
          .sublist("<equation>", false, "One equation: the sum of its terms is its value.");
  equation.set(
      "Terms", "",
      "\"factor body/nodes/component\", several parted by commas: a number, a surface or group of the "
      "body's mesh that has one node, and X, Y or Z.");
  setRequired(equation, {"Terms"});
  addReal(equation, "Value", 0.0, "What the sum is.");
  addReal(
      equation, "Stiffness", 0.0,
      "Of a spring instead, whose force is so many times the difference of the sum and Value: of one term "
      "to the ground, of two between points. 0: the sum is Value.",
      0.0);
  describeStep(
      list.sublist("Steps", false,
                   "Load steps, in their order; without any there is one, with all loads. What friction "
                   "slips is kept from step to step."));
  list.sublist("Decomposition", false, "How each body is cut into subdomains, unless it says so itself.")
      .setParameters(decompositionSchema());
  return list;
}

} // namespace epafi::scene
