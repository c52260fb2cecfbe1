#include "epafi/scene/SceneSchema.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/scene/Scene.hpp"

#include <Teuchos_Array.hpp>

namespace epafi::scene {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

const std::vector<std::string> edges = {"left", "right", "bottom", "top"};

void describeRegions(ParameterList& body) {
  ParameterList& region =
      body.sublist("Regions", false, "Parts of the body with another conductivity.")
          .sublist("<region>", false, "Where regions overlap, the last one in the file holds.");
  region.set("Box", Array<double>(),
             "Must be given. Rectangle {x0, x1, y0, y1}; it holds for elements whose centre lies in it.");
  addReal(region, "Conductivity", Region().conductivity, "Must be given. Conductivity of these elements.",
          0.0, std::numeric_limits<double>::infinity(), true);
}

void describeSupports(ParameterList& body) {
  ParameterList& support = body.sublist("Supports", false, "Edges along which the deflection is prescribed.")
                               .sublist("<support>", false, "One supported edge.");
  addChoice(support, "Edge", "", "Must be given. The supported edge.", edges);
  addReal(support, "Value", Support().value, "Deflection along the edge.");
}

void describeLoads(ParameterList& body) {
  ParameterList& load = body.sublist("Loads", false, "Forces on the body; loads that overlap add up.")
                            .sublist("<load>", false, "One constant load.");
  load.set("Box", Array<double>(), "Rectangle {x0, x1, y0, y1} that carries the load; {} is the whole body.");
  addReal(load, "Value", Load().value, "Must be given. Force per area, positive upwards.");
}

void describeBody(ParameterList& bodies) {
  const Body body;
  ParameterList& list = bodies.sublist("<body>", false, "One body, under a name of your choice.");
  addChoice(list, "Physics", "membrane", "What the body is: a membrane, -div(k grad u) = f.", {"membrane"});
  list.set("Rectangle", Array<double>(), "Must be given. The body's extent {x0, x1, y0, y1}.");
  list.set("Elements", Array<int>(),
           "Must be given. Number of elements {nx, ny} in x and y, each at least 1.");
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
  pair.set("First Body", "", "Must be given. Name of the lower body.");
  addChoice(pair, "First Edge", "", "Must be given. Edge of the first body.", edges);
  pair.set("Second Body", "", "Must be given. Name of the upper body.");
  addChoice(pair, "Second Edge", "", "Must be given. Edge of the second body.", edges);
  addReal(pair, "Gap", ContactPair().gap,
          "Initial gap g: u_second - u_first >= -g along the edge; negative means initial penetration.");
}

} // namespace

ParameterList decompositionSchema() {
  const Decomposition cut;
  ParameterList list("Decomposition");
  addChoice(list, "Method", "grid", "A grid of rectangles, or METIS on the graph of the elements.",
            {"grid", "metis"});
  list.set("Grid", Array<int>(cut.counts.begin(), cut.counts.end()),
           "With the method grid: number of subdomains {nx, ny} in x and y of each body.");
  addInteger(list, "Parts", cut.parts, "With the method metis: number of subdomains of each body.", 1);
  return list;
}

ParameterList sceneSchema() {
  ParameterList list("Epafi");
  list.set("Title", "", "What the scene shows, in a few words.");
  describeBody(list.sublist("Bodies", false, "The bodies, at least one."));
  describePair(list.sublist("Contact", false, "The pairs of edges that cannot penetrate each other."));
  list.sublist("Decomposition", false, "How each body is cut into subdomains, unless it says so itself.")
      .setParameters(decompositionSchema());
  return list;
}

} // namespace epafi::scene
