#include "epafi/scene/BodyReader.hpp"

#include "epafi/base/ParameterValue.hpp"

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

std::string text(const std::array<int, 2>& counts) {
  return '{' + std::to_string(counts[0]) + ", " + std::to_string(counts[1]) + '}';
}

bool isVertical(Edge edge) {
  return edge == Edge::left || edge == Edge::right;
}

/// Nodes are counted by int, and their coordinates must be told apart by a double with digits to spare.
void checkMesh(const ListReader& list, const Body& body) {
  constexpr long long mostNodes = std::numeric_limits<int>::max();
  const auto [nx, ny] = body.elements;
  const long long numNodes = (static_cast<long long>(nx) + 1) * (static_cast<long long>(ny) + 1);
  if (numNodes > mostNodes)
    list.refuseValue("Elements", "that makes " + std::to_string(numNodes) +
                                     " nodes and a body may have at most " + std::to_string(mostNodes));
  const Rectangle& box = body.rectangle;
  constexpr double relativeWidth = 1e-12;
  const auto isTooThin = [](double from, double to, int count) {
    return (to - from) / count <= relativeWidth * std::max(std::abs(from), std::abs(to));
  };
  if (isTooThin(box.x0, box.x1, nx) || isTooThin(box.y0, box.y1, ny))
    list.refuseValue("Rectangle", "elements of its size over " + text(body.elements) +
                                      " are too thin at that distance from the origin to be told apart");
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
    regions.push_back({name, boxInside(region, body), region.positive("Conductivity")});
  }
  return regions;
}

std::vector<Support> readSupports(const ListReader& list) {
  std::vector<Support> supports;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
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
    loads.push_back(
        {name, load.hasEntries("Box") ? boxInside(load, body) : body.rectangle, load.real("Value")});
  }
  return loads;
}

Decomposition readDecomposition(const ListReader& list, const Body& body) {
  Decomposition cut;
  const auto [nx, ny] = body.elements;
  const std::string elements = "body \"" + body.name + "\" has only " + text(body.elements) + " elements";
  if (list.word("Method") == "grid") {
    cut.method = Decomposition::Method::grid;
    const std::array<int, 2> counts = list.counts("Grid");
    cut.counts = {counts[0], counts[1], 1};
    if (cut.counts[0] > nx || cut.counts[1] > ny)
      list.refuseValue("Grid", elements);
  } else {
    cut.method = Decomposition::Method::metis;
    cut.parts = list.integer("Parts");
    if (cut.parts > static_cast<long long>(nx) * ny)
      list.refuseValue("Parts", elements);
  }
  return cut;
}

} // namespace

Body readBody(const std::string& name, const ListReader& list) {
  Body body;
  body.name = name;
  body.rectangle = list.rectangle("Rectangle");
  body.elements = list.counts("Elements");
  checkMesh(list, body);
  body.conductivity = list.positive("Conductivity");
  body.regions = readRegions(list.inside("Regions"), body);
  body.supports = readSupports(list.inside("Supports"));
  body.loads = readLoads(list.inside("Loads"), body);
  body.decomposition = readDecomposition(list.inside("Decomposition"), body);
  return body;
}

} // namespace epafi::scene
