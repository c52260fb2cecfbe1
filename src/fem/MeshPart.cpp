#include "epafi/fem/MeshPart.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/MeshArrays.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>
#include <utility>

namespace epafi::fem {
namespace {

std::size_t index(GlobalOrdinal number) {
  return static_cast<std::size_t>(number);
}

void sortEach(std::vector<GlobalOrdinal>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// Place of a number among ascending ones, their count if it is not there.
std::size_t placeIn(const std::vector<GlobalOrdinal>& numbers, GlobalOrdinal number) {
  const auto found = std::lower_bound(numbers.begin(), numbers.end(), number);
  return static_cast<std::size_t>(
      found != numbers.end() && *found == number ? found - numbers.begin() : numbers.end() - numbers.begin());
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

/// Passes over the arrays in one order for both directions.
template <class Arrays, class Pass>
void visit(Arrays& a, const Pass& pass) {
  pass(a.cellType);
  for (auto* number : {&a.numNodes, &a.numElements, &a.numCorners})
    pass(*number);
  pass(a.box);
  pass(a.elements);
  pass(a.nodes);
  pass(a.cells);
  pass(a.points);
  pass(a.cornerNumbers);
  pass(a.isOnBoundary);
  pass(a.surfaces);
  pass(a.groups);
}

/// Passes values on in pieces: packs them where these are constant, else fills them.
template <class Raw>
class Packing {
public:
  /// \param raw  takes bytes from a place, or puts them there: raw(place, number)
  explicit Packing(Raw raw) : raw_(std::move(raw)) {}
  template <class Value>
  void operator()(Value& value) const {
    if constexpr (std::is_trivially_copyable_v<Value>) {
      raw_(&value, sizeof(Value));
    } else if constexpr (requires { value.facetNodes; }) {
      (*this)(value.facetType);
      (*this)(value.facetNodes);
      (*this)(value.elements);
    } else if constexpr (requires { value.first; }) {
      (*this)(value.first);
      (*this)(value.second);
    } else {
      list(value);
    }
  }

private:
  template <class List>
  void list(List& values) const {
    std::size_t size = values.size();
    raw_(&size, sizeof(size));
    if constexpr (!std::is_const_v<List>)
      values.resize(size);
    if constexpr (std::is_trivially_copyable_v<typename List::value_type>)
      raw_(values.data(), size * sizeof(typename List::value_type));
    else
      for (auto& value : values)
        (*this)(value);
  }
  Raw raw_;
};

} // namespace

std::vector<std::byte> PartArrays::packed() const {
  std::vector<std::byte> bytes;
  visit(*this, Packing([&](const void* from, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + size);
  }));
  return bytes;
}

PartArrays PartArrays::unpacked(const std::vector<std::byte>& bytes) {
  PartArrays arrays;
  auto next = bytes.begin();
  visit(arrays, Packing([&](void* to, std::size_t size) {
          const auto end = next + static_cast<std::ptrdiff_t>(size);
          std::copy(next, end, static_cast<std::byte*>(to));
          next = end;
        }));
  return arrays;
}

MeshCutter::MeshCutter(const Mesh& mesh) : mesh_(mesh), cornerNumbers_(index(mesh.numNodes()), -1) {
  common_.cellType = mesh.cellType();
  common_.numNodes = mesh.numNodes();
  common_.numElements = mesh.numElements();
  common_.box = {mesh.point(0), mesh.point(0)};
  for (GlobalOrdinal node = 1; node < mesh.numNodes(); ++node) {
    const Point point = mesh.point(node);
    for (std::size_t d = 0; d < 3; ++d) {
      common_.box[0][d] = std::min(common_.box[0][d], point[d]);
      common_.box[1][d] = std::max(common_.box[1][d], point[d]);
    }
  }
  const auto corners = index(numCornersOf(mesh.cellType()));
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const ElementNodes nodes(mesh, element);
    for (std::size_t i = 0; i < corners; ++i)
      cornerNumbers_[index(nodes[i])] = 0;
  }
  for (GlobalOrdinal& number : cornerNumbers_)
    if (number == 0)
      number = common_.numCorners++;
  for (const std::string& name : mesh.surfaceNames()) {
    common_.surfaces.emplace_back(name, mesh.surface(name));
    const std::vector<GlobalOrdinal>& at = common_.surfaces.back().second.elements;
    surfaceElements_.insert(surfaceElements_.end(), at.begin(), at.end());
  }
  sortEach(surfaceElements_);
  for (const std::string& name : mesh.groupNames())
    common_.groups.emplace_back(name, std::vector<GlobalOrdinal>());
}

PartArrays MeshCutter::around(std::vector<GlobalOrdinal> elements) const {
  PartArrays part(common_);
  const auto perElement = index(mesh_.nodesPerElement());
  const auto nodesOfAll = [&](const std::vector<GlobalOrdinal>& which) {
    std::vector<GlobalOrdinal> nodes(which.size() * perElement);
    mesh_.elementNodes(which, nodes);
    return nodes;
  };
  std::vector<GlobalOrdinal> ownNodes = nodesOfAll(elements), touching;
  sortEach(ownNodes);
  part.elements = std::move(elements);
  for (const GlobalOrdinal node : ownNodes) {
    mesh_.nodeElements(node, touching);
    part.elements.insert(part.elements.end(), touching.begin(), touching.end());
  }
  part.elements.insert(part.elements.end(), surfaceElements_.begin(), surfaceElements_.end());
  sortEach(part.elements);
  const std::vector<GlobalOrdinal> cells = nodesOfAll(part.elements);
  part.nodes = cells;
  sortEach(part.nodes);
  part.cells.reserve(cells.size());
  for (const GlobalOrdinal node : cells)
    part.cells.push_back(static_cast<LocalOrdinal>(placeIn(part.nodes, node)));
  mesh_.pointsAt(part.nodes, part.points);
  for (const GlobalOrdinal node : part.nodes) {
    part.cornerNumbers.push_back(cornerNumbers_[index(node)]);
    part.isOnBoundary.push_back(mesh_.isBoundaryNode(node) ? 1 : 0);
  }
  for (auto& [name, held] : part.groups) {
    const std::vector<GlobalOrdinal> all = mesh_.group(name);
    std::set_intersection(all.begin(), all.end(), part.elements.begin(), part.elements.end(),
                          std::back_inserter(held));
  }
  return part;
}

MeshPart::MeshPart(PartArrays arrays)
    : arrays_(std::move(arrays)),
      topology_(arrays_.cellType, static_cast<LocalOrdinal>(arrays_.nodes.size()), arrays_.cells) {}

std::size_t MeshPart::placeOf(GlobalOrdinal node) const {
  const std::size_t place = placeIn(arrays_.nodes, node);
  if (place == arrays_.nodes.size())
    throw Error("Node " + std::to_string(node) + " of a mesh is asked for on a rank that does not hold it.");
  return place;
}

LocalOrdinal MeshPart::placeOfElement(GlobalOrdinal element) const {
  const std::size_t place = placeIn(arrays_.elements, element);
  if (place == arrays_.elements.size())
    throw Error("Element " + std::to_string(element) +
                " of a mesh is asked for on a rank that does not hold it.");
  return static_cast<LocalOrdinal>(place);
}

/// Surfaces lose the nodes between their corners.
std::unique_ptr<const MeshPart> MeshPart::ofOrder1() const {
  PartArrays part(arrays_);
  part.cellType = withOrder(arrays_.cellType, 1);
  part.numNodes = arrays_.numCorners;
  const auto corners = index(numCornersOf(part.cellType));
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
    const auto nodes = nodesOf(arrays_.cellType, arrays_.cells, static_cast<LocalOrdinal>(element));
    for (std::size_t i = 0; i < corners; ++i)
      part.cells.push_back(place[index(nodes[i])]);
  }
  for (auto& [name, surface] : part.surfaces) {
    const Surface whole = std::move(surface);
    surface = {facetTypeOf(part.cellType), {}, whole.elements};
    for (std::size_t f = 0; f < whole.numFacets(); ++f)
      for (const GlobalOrdinal node : whole.facet(f).first(index(numCornersOf(whole.facetType))))
        surface.facetNodes.push_back(arrays_.cornerNumbers[placeOf(node)]);
  }
  return std::make_unique<const MeshPart>(std::move(part));
}

void MeshPart::elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const {
  const auto own = nodesOf(arrays_.cellType, arrays_.cells, placeOfElement(element));
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
    for (const LocalOrdinal element : topology_.elementsOf(static_cast<LocalOrdinal>(place)))
      elements.push_back(arrays_.elements[index(element)]);
}

void MeshPart::numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    numbers[i] = static_cast<int>(topology_.elementsOf(static_cast<LocalOrdinal>(placeOf(nodes[i]))).size());
}

void MeshPart::elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const LocalOrdinal own = placeOfElement(element);
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

} // namespace epafi::fem
