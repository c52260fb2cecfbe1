#include "epafi/fem/RectangleMesh.hpp"

#include "epafi/fem/GridWalk.hpp"

#include <algorithm>

namespace epafi::fem {
namespace {

constexpr std::array<scene::Edge, 4> allEdges{scene::Edge::left, scene::Edge::right, scene::Edge::bottom,
                                              scene::Edge::top};

} // namespace

RectangleMesh::RectangleMesh(const scene::Rectangle& rectangle, std::array<int, 2> elements)
    : rectangle_(rectangle), elements_(elements) {}

GlobalOrdinal RectangleMesh::numNodes() const {
  return static_cast<GlobalOrdinal>(elements_[0] + 1) * (elements_[1] + 1);
}

GlobalOrdinal RectangleMesh::numElements() const {
  return static_cast<GlobalOrdinal>(elements_[0]) * elements_[1];
}

Point RectangleMesh::point(GlobalOrdinal node) const {
  const GlobalOrdinal i = node % (elements_[0] + 1), j = node / (elements_[0] + 1);
  // Interpolated from both ends, so that the last node lies on the far edge to the last digit.
  const auto between = [](double a, double b, GlobalOrdinal k, int n) {
    const double t = static_cast<double>(k) / n;
    return (1 - t) * a + t * b;
  };
  return {between(rectangle_.x0, rectangle_.x1, i, elements_[0]),
          between(rectangle_.y0, rectangle_.y1, j, elements_[1]), 0.0};
}

void RectangleMesh::elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const {
  const GlobalOrdinal i = element % elements_[0], j = element / elements_[0];
  const GlobalOrdinal row = elements_[0] + 1, lowerLeft = i + j * row;
  nodes[0] = lowerLeft;
  nodes[1] = lowerLeft + 1;
  nodes[2] = lowerLeft + row + 1;
  nodes[3] = lowerLeft + row;
}

void RectangleMesh::elementNodes(std::span<const GlobalOrdinal> elements,
                                 std::span<GlobalOrdinal> nodes) const {
  const GlobalOrdinal row = elements_[0] + 1;
  GridWalk walk(elements_[0]);
  auto next = nodes.begin();
  for (const GlobalOrdinal element : elements) {
    walk.to(element);
    const GlobalOrdinal lowerLeft = walk.column() + walk.row() * row;
    *next++ = lowerLeft;
    *next++ = lowerLeft + 1;
    *next++ = lowerLeft + row + 1;
    *next++ = lowerLeft + row;
  }
}

void RectangleMesh::nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const GlobalOrdinal i = node % (elements_[0] + 1), j = node / (elements_[0] + 1);
  for (GlobalOrdinal ej = std::max<GlobalOrdinal>(j - 1, 0);
       ej <= std::min<GlobalOrdinal>(j, elements_[1] - 1); ++ej)
    for (GlobalOrdinal ei = std::max<GlobalOrdinal>(i - 1, 0);
         ei <= std::min<GlobalOrdinal>(i, elements_[0] - 1); ++ei)
      elements.push_back(ei + ej * elements_[0]);
}

void RectangleMesh::numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const {
  std::fill(numbers.begin(), numbers.end(), 4);
  std::vector<std::size_t> places;
  for (const scene::Edge edge : allEdges) {
    placesOnEdge(edge, nodes, places);
    for (const std::size_t place : places)
      numbers[place] /= 2;
  }
}

void RectangleMesh::elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const GlobalOrdinal i = element % elements_[0], j = element / elements_[0];
  if (j > 0)
    elements.push_back(element - elements_[0]);
  if (i > 0)
    elements.push_back(element - 1);
  if (i + 1 < elements_[0])
    elements.push_back(element + 1);
  if (j + 1 < elements_[1])
    elements.push_back(element + elements_[0]);
}

bool RectangleMesh::isBoundaryNode(GlobalOrdinal node) const {
  const GlobalOrdinal i = node % (elements_[0] + 1), j = node / (elements_[0] + 1);
  return i == 0 || j == 0 || i == elements_[0] || j == elements_[1];
}

std::vector<std::string> RectangleMesh::surfaceNames() const {
  std::vector<std::string> names;
  for (const scene::Edge edge : allEdges)
    names.push_back(toString(edge));
  return names;
}

Surface RectangleMesh::surface(const std::string& name) const {
  const scene::Edge edge =
      *std::find_if(allEdges.begin(), allEdges.end(), [&](scene::Edge e) { return toString(e) == name; });
  const bool isReversed =
      edge == scene::Edge::left || edge == scene::Edge::top; // the body lies on a facet's left side
  Surface surface;
  for (GlobalOrdinal k = 0; k + 1 < numEdgeNodes(edge); ++k) {
    const GlobalOrdinal a = edgeNode(edge, k), b = edgeNode(edge, k + 1);
    surface.facetNodes.insert(surface.facetNodes.end(), {isReversed ? b : a, isReversed ? a : b});
    const GlobalOrdinal last = elements_[0] - 1, top = elements_[1] - 1;
    surface.elements.push_back(edge == scene::Edge::left     ? k * elements_[0]
                               : edge == scene::Edge::right  ? k * elements_[0] + last
                               : edge == scene::Edge::bottom ? k
                                                             : top * elements_[0] + k);
  }
  return surface;
}

std::vector<GlobalOrdinal> RectangleMesh::group(const std::string& /*name*/) const {
  return {};
}

scene::Rectangle RectangleMesh::elementBox(GlobalOrdinal element) const {
  std::array<GlobalOrdinal, 4> nodes{};
  elementNodes(element, nodes);
  const Point lower = point(nodes[0]), upper = point(nodes[2]);
  return {lower[0], upper[0], lower[1], upper[1]};
}

GlobalOrdinal RectangleMesh::numEdgeNodes(scene::Edge edge) const {
  return (edge == scene::Edge::left || edge == scene::Edge::right ? elements_[1] : elements_[0]) + 1;
}

GlobalOrdinal RectangleMesh::edgeNode(scene::Edge edge, GlobalOrdinal k) const {
  const GlobalOrdinal row = elements_[0] + 1;
  switch (edge) {
  case scene::Edge::left:
    return k * row;
  case scene::Edge::right:
    return k * row + elements_[0];
  case scene::Edge::bottom:
    return k;
  case scene::Edge::top:
    return elements_[1] * row + k;
  }
  return -1;
}

GlobalOrdinal RectangleMesh::positionOnEdge(scene::Edge edge, GlobalOrdinal node) const {
  const GlobalOrdinal i = node % (elements_[0] + 1), j = node / (elements_[0] + 1);
  switch (edge) {
  case scene::Edge::left:
    return i == 0 ? j : -1;
  case scene::Edge::right:
    return i == elements_[0] ? j : -1;
  case scene::Edge::bottom:
    return j == 0 ? i : -1;
  case scene::Edge::top:
    return j == elements_[1] ? i : -1;
  }
  return -1;
}

void RectangleMesh::placesOnEdge(scene::Edge edge, std::span<const GlobalOrdinal> nodes,
                                 std::vector<std::size_t>& places) const {
  places.clear();
  if (nodes.empty())
    return;
  const GlobalOrdinal row = elements_[0] + 1;
  auto place = nodes.begin();
  if (edge == scene::Edge::bottom || edge == scene::Edge::top) { // one run of nodes
    const GlobalOrdinal first = edgeNode(edge, 0);
    for (place = std::lower_bound(place, nodes.end(), first); place != nodes.end() && *place < first + row;
         ++place)
      places.push_back(static_cast<std::size_t>(place - nodes.begin()));
    return;
  }
  for (GlobalOrdinal j = nodes.front() / row; j <= nodes.back() / row; ++j) { // one node a row
    const GlobalOrdinal wanted = edgeNode(edge, j);
    place = std::lower_bound(place, nodes.end(), wanted);
    if (place != nodes.end() && *place == wanted)
      places.push_back(static_cast<std::size_t>(place - nodes.begin()));
  }
}

} // namespace epafi::fem
