#include "epafi/scene/SceneSchema.hpp"

#include "epafi/base/Parameters.hpp"

#include <Teuchos_Array.hpp>

namespace epafi::scene {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

const std::vector<std::string> edges{"left", "right", "bottom", "top"};

void addDecomposition(ParameterList& list, const std::string& whose) {
  ParameterList& cut = list.sublist("Decomposition", false, "How " + whose + " cut into subdomains.");
  addChoice(cut, "Method", "grid", "grid: rectangles; metis: parts of the dual graph, made connected.", {"grid", "metis"});
  cut.set("Grid", Array<int>{2, 2}, "grid: subdomains in x and in y.");
  addInteger(cut, "Parts", 4, "metis: number of parts a body.", 1);
}

void addBody(ParameterList& bodies) {
  ParameterList& body = bodies.sublist("<body>", false, "One body; its name is of your choice.");
  addChoice(body, "Physics", "membrane", "membrane: -div(conductivity grad u) = load.", {"membrane"});
  body.set("Rectangle", Array<double>(), "Required: {x0, x1, y0, y1}, in units of length.");
  body.set("Elements", Array<int>(), "Required: number of bilinear elements in x and in y.");
  addReal(body, "Conductivity", 1.0, "Tension of the membrane: force per length.", 0.0,
          std::numeric_limits<double>::infinity(), true);

  ParameterList& region = body.sublist("Regions").sublist("<region>", false, "Where the conductivity differs.");
  region.set("Box", Array<double>(), "Required: {x0, x1, y0, y1}; elements whose centre lies in it.");
  addReal(region, "Conductivity", 1.0, "Of these elements; the last region that holds an element's centre counts.", 0.0,
          std::numeric_limits<double>::infinity(), true);

  ParameterList& support = body.sublist("Supports").sublist("<support>", false, "An edge that is held.");
  addChoice(support, "Edge", "left", "Which edge.", edges);
  addReal(support, "Value", 0.0, "Deflection u prescribed there.");

  ParameterList& load = body.sublist("Loads").sublist("<load>", false, "A constant load; loads that overlap add up.");
  load.set("Box", Array<double>(), "{x0, x1, y0, y1}; empty for the whole body. It may cut elements.");
  addReal(load, "Value", 0.0, "Force per area; negative presses downwards.");
  addDecomposition(body, "this body is");
}

} // namespace

ParameterList sceneSchema() {
  ParameterList schema("Epafi");
  schema.set("Title", "", "What the scene shows; stands in reports.");
  addBody(schema.sublist("Bodies"));
  ParameterList& pair = schema.sublist("Contact").sublist(
      "<pair>", false, "Two coinciding edges: u_second - u_first >= -gap at each of their nodes.");
  pair.set("First Body", "", "Required: the body below.");
  addChoice(pair, "First Edge", "right", "Its edge.", edges);
  pair.set("Second Body", "", "Required: the body above.");
  addChoice(pair, "Second Edge", "left", "Its edge.", edges);
  addReal(pair, "Gap", 0.0, "Initial gap in units of u; negative for initial penetration.");
  addDecomposition(schema, "every body that does not say otherwise is");
  return schema;
}

} // namespace epafi::scene
