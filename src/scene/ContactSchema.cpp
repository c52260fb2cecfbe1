#include "epafi/scene/ContactSchema.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/scene/EdgeContact.hpp"
#include "epafi/scene/Scene.hpp"

#include <Teuchos_Array.hpp>

#include <limits>

namespace epafi::scene {

namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

} // namespace

void describeObstacle(Teuchos::ParameterList& obstacles) {
  ParameterList& obstacle = obstacles.sublist("<obstacle>", false, "One obstacle, which does not move.");
  addChoice(obstacle, "Kind", "",
            "A half-space, a circle (in the plane), a sphere or an endless cylinder. Axisymmetric bodies "
            "meet planes y = constant, and spheres as circles about a point of the axis. Membranes lie at "
            "z = 0 and meet what is below or above them along z.",
            {"plane", "circle", "sphere", "cylinder"});
  addArray(obstacle, "Point", Array<double>(),
           "A point on the plane or the cylinder's axis, or the centre: {x, y} or {x, y, z}.", "");
  setRequired(obstacle, {"Kind", "Point"});
  addArray(obstacle, "Normal", Array<double>(),
           "Plane, required: its normal {x, y} or {x, y, z} towards the body, of any length.", "");
  addArray(obstacle, "Axis", Array<double>(), "Cylinder, required: {x, y, z} along its axis, of any length.",
           "");
  addReal(obstacle, "Radius", 1.0, "Circle, sphere and cylinder, required: the radius.", 0.0,
          std::numeric_limits<double>::infinity(), true);
  addChoice(obstacle, "Side", "outside",
            "Circle, sphere and cylinder: where the body is. inside: the obstacle is a bore or a cup.",
            {"outside", "inside"});
}

void describePair(Teuchos::ParameterList& contact) {
  ParameterList& pair =
      contact.sublist("<pair>", false,
                      "Two edges or surfaces, meshed alike or not, or a surface and an obstacle. "
                      "Membranes on rectangles: "
                      "two coinciding edges; the second body must stay above the first one.");
  addChoice(
      pair, "Kind", "contact",
      "Bodies that cannot penetrate each other, or that are tied: bonded as they are, in all directions.",
      {"contact", "tied"});
  pair.set("First Body", "", "Name of the first (of membranes: the lower) body.");
  setRequired(pair, {"First Body"});
  addChoice(pair, "First Edge", "", "Membranes on rectangles, required: edge of the first body.",
            std::vector<std::string>(edges.begin(), edges.end()));
  pair.set("First Surface", "",
           "All other bodies, required but for membranes on obstacles: surface of the first body.");
  pair.set("Second Body", "", "Name of the second (of membranes: the upper) body.");
  addChoice(pair, "Second Edge", "", "Membranes on rectangles, required: edge of the second body.",
            std::vector<std::string>(edges.begin(), edges.end()));
  pair.set("Second Surface", "", "All other bodies, required: surface of the second body.");
  pair.set("Obstacle", "", "Name of the obstacle that the first body meets instead of a second one.");
  addReal(pair, "Gap", SurfaceContact().gap,
          "Initial gap g between membranes: u_second − u_first ≥ −g; of elastic bodies what is added to the "
          "gap that "
          "their shapes leave. Negative means initial penetration.");
  addReal(
      pair, "Friction", 0.0,
      "Elastic bodies: Coulomb's coefficient. Where the surfaces touch, tangential tractions are at most so "
      "many times the pressure, and they slip where that is not enough.",
      0.0);
  addReal(
      pair, "Friction Bound", 0.0,
      "Elastic bodies, instead of Friction: tangential tractions are at most this (force per area, Tresca's "
      "law), whatever the pressure is.",
      0.0);
  addReal(pair, "Adjust", 0.0,
          "Elastic bodies: gaps that their shapes leave count as none up to this one, and so do overlaps, "
          "before Gap is "
          "added; without it all count as they are.",
          0.0);
  pair.set(
      "Adjust Nodes", "",
      "A set of nodes of the first body, which then carries the multipliers: the gaps that shapes leave at "
      "them count as none, whatever they are.");
  addReal(pair, "Stiffness", 0.0,
          "Elastic bodies: pressure over overclosure, force per volume, of surfaces that give way; 0: they "
          "do not. Of a tied joint also tension over what it opens.",
          0.0);
  addReal(pair, "Stick Slope", 0.0,
          "With friction: tangential traction over the shift of surfaces that stick, force per volume; 0: "
          "they do not "
          "shift. Of a tied joint that gives way: 0 is its Stiffness.",
          0.0);
  pair.set(
      "Preload", "",
      "Tied joint that is a section of a bolt's shank: \"force 100\", its tension, or \"shortening 0.1\", "
      "the length that is taken out of it along the section's normal.");
  addArray(pair, "Preload Direction", Array<double>(),
           "The section's normal, out of the first body, of any length; if not given, the mean one of its "
           "surface.",
           "");
  addReal(pair, "Distance", 0.0,
          "Nodes that are farther than this from the other side get no inequality; 0: no limit. Should they "
          "meet all the same, the run ends with code 1 and `MissedContact`. Not of membranes on rectangles.",
          0.0);
  addChoice(pair, "Coupling", "auto",
            "How two surfaces are coupled: \"nodes\" that face each other in pairs, where the meshes match; "
            "\"mortar\", integrals over what the surfaces have in common; \"auto\": pairs where all match, "
            "else mortars.",
            {"auto", "nodes", "mortar"});
  addChoice(
      pair, "Multipliers", "auto",
      "With mortars: which surface carries the multipliers. \"auto\": one that no support holds, then one "
      "that no other contact has, then the one that is finer by half, then the one that the other covers, "
      "then that of the softer body, then the finer, then the first.",
      {"auto", "first", "second"});
}

} // namespace epafi::scene
