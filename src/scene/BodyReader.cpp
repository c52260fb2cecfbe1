#include "epafi/scene/BodyReader.hpp"

#include "epafi/base/ParameterValue.hpp"
#include "epafi/scene/SolidReader.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::scene {
namespace {

bool overlap(const Rectangle& a, const Rectangle& b) {
  return std::max(a.x0, b.x0) < std::min(a.x1, b.x1) && std::max(a.y0, b.y0) < std::min(a.y1, b.y1);
}

std::string text(const Rectangle& box) {
  return '{' + valueText(box.x0) + ", " + valueText(box.x1) + ", " + valueText(box.y0) + ", " +
         valueText(box.y1) + '}';
}

const std::string noMesh = "the body has no mesh file with groups and surfaces";

void refuseElastic(const ListReader& list) {
  list.refuseGiven({"Young's Modulus", "Poisson's Ratio", "Thickness"}, "membranes have none; remove it");
}

bool isVertical(Edge edge) {
  return edge == Edge::left || edge == Edge::right;
}

Rectangle boxInside(const ListReader& list, const Body& body) {
  const Rectangle box = list.rectangle("Box");
  if (!overlap(box, body.rectangle))
    list.refuseValue("Box",
                     "must overlap the body \"" + body.name + "\", which fills " + text(body.rectangle));
  return box;
}

std::vector<Region> readRegions(const ListReader& list, const Body& body) {
  std::vector<Region> regions;
  for (const std::string& name : list.names()) {
    const ListReader region = list.inside(name);
    refuseElastic(region);
    region.refuseGiven({"Group"}, noMesh);
    for (const char* const needed : {"Box", "Conductivity"})
      region.require(needed);
    regions.push_back({name, boxInside(region, body), region.positive("Conductivity")});
  }
  return regions;
}

std::vector<Support> readSupports(const ListReader& list) {
  std::vector<Support> supports;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    entry.refuseGiven({"Surface"}, "a membrane on a rectangle is supported on an \"Edge\"");
    entry.refuseGiven({"X", "Y", "Z"}, "a membrane's deflection is its \"Value\"");
    entry.require("Edge");
    const Support support{name, entry.edge("Edge"), entry.real("Value")};
    for (const Support& other : supports) {
      if (other.edge == support.edge)
        entry.refuseValue("Edge", "that edge has the support \"" + other.name + "\" already");
      if (isVertical(other.edge) != isVertical(support.edge) && other.value != support.value)
        entry.refuseValue("Value", "must equal the value " + valueText(other.value) + " of the support \"" +
                                       other.name + "\", with which it shares a corner");
    }
    supports.push_back(support);
  }
  return supports;
}

std::vector<Load> readLoads(const ListReader& list, const Body& body) {
  std::vector<Load> loads;
  for (const std::string& name : list.names()) {
    const ListReader load = list.inside(name);
    if (load.word("Kind") != "body")
      load.refuseValue("Kind", "a membrane on a rectangle carries loads of the kind \"body\" only");
    load.refuseGiven({"Group", "Surface"}, noMesh);
    load.refuseGiven({"Point"}, "a load of the kind \"body\" has no use for it");
    load.refuseGiven({"Force"}, "a membrane's load is a number, its \"Value\"");
    load.require("Value");
    loads.push_back(
        {name, load.hasEntries("Box") ? boxInside(load, body) : body.rectangle, load.real("Value")});
  }
  return loads;
}

/// Elements in x, y and z of a structured mesh; zeros of another one.
std::array<int, 3> elementsOf(const Body& body) {
  return body.solid ? body.solid->mesh.elements : std::array<int, 3>{body.elements[0], body.elements[1], 0};
}

std::string text(const std::array<int, 3>& counts) {
  return '{' + std::to_string(counts[0]) + ", " + std::to_string(counts[1]) +
         (counts[2] > 0 ? ", " + std::to_string(counts[2]) : "") + '}';
}

Decomposition readDecomposition(const ListReader& list, const Body& body) {
  Decomposition cut;
  const std::array<int, 3> elements = elementsOf(body);
  const bool isStructured = elements[0] > 0;
  const std::string tooMany = "body \"" + body.name + "\" has only " + text(elements) + " elements";
  if (list.word("Method") == "grid" && (isStructured || list.has("Method"))) {
    if (!isStructured)
      list.refuseValue("Method", "body \"" + body.name + "\" has a mesh file; cut it by \"metis\"");
    cut.method = Decomposition::Method::grid;
    if (const int dimension = elements[2] > 0 ? 3 : 2; list.has("Grid") || dimension == 2)
      cut.counts = list.counts("Grid", dimension);
    else
      for (std::size_t d = 0; d < 3; ++d)
        cut.counts[d] = std::min(cut.counts[d], elements[d]);
    for (std::size_t d = 0; d < 3; ++d)
      if (cut.counts[d] > std::max(elements[d], 1))
        list.refuseValue("Grid", tooMany);
  } else {
    cut.method = Decomposition::Method::metis;
    cut.parts = list.integer("Parts");
    if (isStructured &&
        cut.parts > static_cast<long long>(elements[0]) * elements[1] * std::max(elements[2], 1))
      list.refuseValue("Parts", tooMany);
  }
  return cut;
}

Physics physicsOf(const std::string& word) {
  for (const Physics physics : {Physics::planeStrain, Physics::planeStress, Physics::elasticity3d})
    if (toString(physics) == word)
      return physics;
  return Physics::membrane;
}

void readMembrane(const ListReader& list, Body& body) {
  refuseElastic(list);
  list.refuseGiven({"Box"}, "a membrane has a \"Rectangle\"");
  list.refuseGiven({"Group"}, noMesh);
  for (const char* const needed : {"Rectangle", "Elements"})
    list.require(needed);
  body.rectangle = list.rectangle("Rectangle");
  const std::array<int, 3> elements = list.counts("Elements", 2);
  requireTellableNodes(list, "Rectangle", list.box("Rectangle", 2), elements, 2);
  body.elements = {elements[0], elements[1]};
  body.conductivity = list.positive("Conductivity");
  body.regions = readRegions(list.inside("Regions"), body);
  body.supports = readSupports(list.inside("Supports"));
  body.loads = readLoads(list.inside("Loads"), body);
}

} // namespace

Body readBody(const std::string& name, const ListReader& list) {
  Body body;
  body.name = name;
  const Physics physics = physicsOf(list.word("Physics"));
  if (physics == Physics::membrane && !list.hasEntries("Mesh"))
    readMembrane(list, body);
  else
    body.solid = readSolid(list, physics);
  body.decomposition = readDecomposition(list.inside("Decomposition"), body);
  return body;
}

} // namespace epafi::scene
