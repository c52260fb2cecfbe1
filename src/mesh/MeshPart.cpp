#include "epafi/mesh/MeshPart.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/mesh/MeshArrays.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace epafi::mesh {
namespace {

/// Place of a number among ascending ones, their count if it is not there.
std::size_t placeIn(const std::vector<GlobalOrdinal>& numbers, GlobalOrdinal number) {
  const auto found = std::lower_bound(numbers.begin(), numbers.end(), number);
  return found != numbers.end() && *found == number ? found - numbers.begin() : numbers.size();
}

template <class Value>
const Value& named(const std::vector<std::pair<std::string, Value>>& list, const std::string& name) {
  return std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.first == name; })
      ->second;
}

template <class Value>
std::vector<std::string> namesOf(const std::vector<std::pair<std::string, Value>>& list) {
  std::vector<std::string> names;
  for (const auto& entry : list)
    names.push_back(entry.first);
  return names;
}

} // namespace

MeshPart::MeshPart(PartArrays arrays)
    : arrays_(std::move(arrays)),
      topology_(arrays_.cellType, static_cast<LocalOrdinal>(arrays_.nodes.size()), arrays_.cells) {}

std::size_t MeshPart::placeOf(GlobalOrdinal node) const {
  const std::size_t place = placeIn(arrays_.nodes, node);
  if (place == arrays_.nodes.size())
    throw Error("Node " + std::to_string(node) + " of a mesh is asked for on a rank that does not hold it.");
  return place;
}

std::size_t MeshPart::placeOfElement(GlobalOrdinal element) const {
  const std::size_t place = placeIn(arrays_.elements, element);
  if (place == arrays_.elements.size())
    throw Error("Element " + std::to_string(element) +
                " of a mesh is asked for on a rank that does not hold it.");
  return place;
}

/// Surfaces lose the nodes between their corners.
std::unique_ptr<const MeshPart> MeshPart::ofOrder1() const {
  PartArrays part(arrays_);
  part.cellType = withOrder(arrays_.cellType, 1);
  part.numNodes = arrays_.numCorners;
  const auto perElement = index(numNodesOf(part.cellType));
  std::vector<LocalOrdinal> place(arrays_.nodes.size(), -1); // of order 1
  part.nodes.clear();
  part.points.clear();
  part.isOnBoundary.clear();
  for (std::size_t node = 0; node < place.size(); ++node) {
    if (arrays_.cornerNumbers[node] < 0)
      continue;
    place[node] = static_cast<LocalOrdinal>(part.nodes.size());
    part.nodes.push_back(arrays_.cornerNumbers[node]); // ascend as the nodes do
    part.points.push_back(arrays_.points[node]);
    part.isOnBoundary.push_back(arrays_.isOnBoundary[node]);
  }
  part.cornerNumbers = part.nodes;
  part.cells.clear();
  for (std::size_t element = 0; element < arrays_.elements.size(); ++element) {
    const auto nodes = nodesOf(arrays_.cellType, arrays_.cells, element);
    for (const LocalOrdinal node : nodes.first(index(numCornersOf(cellOf(arrays_.cellType, nodes.size())))))
      part.cells.push_back(place[index(node)]);
    fillRow(part.cells, element * perElement, perElement);
  }
  for (auto& [name, nodes] : part.nodeSets) {
    std::erase_if(nodes, [&](GlobalOrdinal node) { return arrays_.cornerNumbers[placeOf(node)] < 0; });
    for (GlobalOrdinal& node : nodes)
      node = arrays_.cornerNumbers[placeOf(node)];
  }
  for (auto& [name, surface] : part.surfaces) {
    const Surface whole = std::move(surface);
    surface = {facetTypeOf(part.cellType), {}, whole.elements};
    std::vector<GlobalOrdinal> facet;
    for (std::size_t f = 0; f < whole.numFacets(); ++f) {
      facet.clear();
      for (const GlobalOrdinal node : whole.corners(f))
        facet.push_back(arrays_.cornerNumbers[placeOf(node)]);
      surface.add(facet);
    }
  }
  return std::make_unique<const MeshPart>(std::move(part));
}

void MeshPart::elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const {
  const auto own = rowOf(arrays_.cellType, arrays_.cells, placeOfElement(element));
  std::transform(own.begin(), own.end(), nodes.begin(),
                 [&](LocalOrdinal place) { return arrays_.nodes[index(place)]; });
}

void MeshPart::elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const {
  const auto count = index(nodesPerElement());
  for (std::size_t i = 0; i < elements.size(); ++i)
    elementNodes(elements[i], nodes.subspan(i * count, count));
}

void MeshPart::nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  if (const std::size_t place = placeIn(arrays_.nodes, node); place < arrays_.nodes.size())
    for (const LocalOrdinal element : topology_.elementsOf(place))
      elements.push_back(arrays_.elements[index(element)]);
}

void MeshPart::numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    numbers[i] = static_cast<int>(topology_.elementsOf(placeOf(nodes[i])).size());
}

void MeshPart::elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const std::size_t own = placeOfElement(element);
  for (std::size_t f = 0; f < facetsOf(arrays_.cellType).size(); ++f)
    if (const LocalOrdinal other = topology_.across(own, f); other >= 0)
      elements.push_back(arrays_.elements[index(other)]);
}

std::vector<std::string> MeshPart::surfaceNames() const {
  return namesOf(arrays_.surfaces);
}

Surface MeshPart::surface(const std::string& name) const {
  return named(arrays_.surfaces, name);
}

std::vector<std::string> MeshPart::groupNames() const {
  return namesOf(arrays_.groups);
}

std::vector<GlobalOrdinal> MeshPart::group(const std::string& name) const {
  return named(arrays_.groups, name);
}

std::vector<std::string> MeshPart::nodeSetNames() const {
  return namesOf(arrays_.nodeSets);
}

std::vector<GlobalOrdinal> MeshPart::nodeSet(const std::string& name) const {
  return named(arrays_.nodeSets, name);
}

} // namespace epafi::mesh
