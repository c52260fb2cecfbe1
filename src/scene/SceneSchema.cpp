#include "epafi/scene/SceneSchema.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/scene/Scene.hpp"

#include <Teuchos_Array.hpp>

namespace epafi::scene {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

const std::vector<std::string> edges = {"left", "right", "bottom", "top"};
/// What the arrays may hold, for the reference; ListReader checks it.
const std::string box = "x0 < x1, y0 < y1", counts = "each ≥ 1";

void describeRegions(ParameterList& body) {
  ParameterList& region =
      body.sublist("Regions", false, "Parts of the body with another conductivity.")
          .sublist("<region>", false, "Where regions overlap, the last one in the file holds.");
  addArray(region, "Box", Array<double>(),
           "Rectangle {x0, x1, y0, y1}; it holds for elements whose centre lies in it.", box);
  addReal(region, "Conductivity", Region().conductivity, "Conductivity of these elements.", 0.0,
          std::numeric_limits<double>::infinity(), true);
  setRequired(region, {"Box", "Conductivity"});
}

void describeSupports(ParameterList& body) {
  ParameterList& support = body.sublist("Supports", false, "Edges along which the deflection is prescribed.")
                               .sublist("<support>", false, "One supported edge.");
  addChoice(support, "Edge", "", "The supported edge.", edges);
  setRequired(support, {"Edge"});
  addReal(support, "Value", Support().value, "Deflection along the edge.");
}

void describeLoads(ParameterList& body) {
  ParameterList& load = body.sublist("Loads", false, "Forces on the body; loads that overlap add up.")
                            .sublist("<load>", false, "One constant load.");
  addArray(load, "Box", Array<double>(),
           "Rectangle {x0, x1, y0, y1} that carries the load; {} is the whole body.", box);
  addReal(load, "Value", Load().value, "Force per area, positive upwards.");
  setRequired(load, {"Value"});
}

void describeBody(ParameterList& bodies) {
  const Body body;
  ParameterList& list = bodies.sublist("<body>", false, "One body, under a name of your choice.");
  addChoice(list, "Physics", "membrane", "What the body is: a membrane, −∇·(κ∇u) = f.", {"membrane"});
  addArray(list, "Rectangle", Array<double>(), "The body's extent {x0, x1, y0, y1}.", box);
  addArray(list, "Elements", Array<int>(), "Number of elements {nx, ny} in x and y.", counts);
  setRequired(list, {"Rectangle", "Elements"});
  addReal(list, "Conductivity", body.conductivity,
          "Conductivity (tension) of the body outside of its regions.", 0.0,
          std::numeric_limits<double>::infinity(), true);
  describeRegions(list);
  describeSupports(list);
  describeLoads(list);
  list.sublist("Decomposition", false,
               "How this body is cut; what is not given here holds as the scene's Decomposition says.")
      .setParameters(decompositionSchema());
}

void describePair(ParameterList& contact) {
  ParameterList& pair = contact.sublist(
      "<pair>", false, "Two coinciding edges; the second body must stay above the first one.");
  pair.set("First Body", "", "Name of the lower body.");
  addChoice(pair, "First Edge", "", "Edge of the first body.", edges);
  pair.set("Second Body", "", "Name of the upper body.");
  addChoice(pair, "Second Edge", "", "Edge of the second body.", edges);
  setRequired(pair, {"First Body", "First Edge", "Second Body", "Second Edge"});
  addReal(pair, "Gap", ContactPair().gap,
          "Initial gap g: u_second − u_first ≥ −g along the edge; negative means initial penetration.");
}

} // namespace

ParameterList decompositionSchema() {
  const Decomposition cut;
  ParameterList list("Decomposition");
  addChoice(list, "Method", "grid", "A grid of rectangles, or METIS on the graph of the elements.",
            {"grid", "metis"});
  addArray(list, "Grid", Array<int>(cut.counts.begin(), cut.counts.begin() + 2),
           "With the method grid: number of subdomains {nx, ny} in x and y of each body.", counts);
  addInteger(list, "Parts", cut.parts, "With the method metis: number of subdomains of each body.", 1);
  return list;
}

ParameterList sceneSchema() {
  ParameterList list("Epafi");
  list.set("Title", "", "What the scene shows, in a few words.");
  describeBody(list.sublist(
      "Bodies", false,
      "The bodies, at least one. Real numbers in a scene are 0 or between 1e-30 and 1e30 in magnitude."));
  describePair(list.sublist("Contact", false, "The pairs of edges that cannot penetrate each other."));
  list.sublist("Decomposition", false, "How each body is cut into subdomains, unless it says so itself.")
      .setParameters(decompositionSchema());
  return list;
}

} // namespace epafi::scene
