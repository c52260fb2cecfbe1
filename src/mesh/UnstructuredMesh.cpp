#include "epafi/mesh/UnstructuredMesh.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/mesh/MeshChecks.hpp"
#include "epafi/mesh/SmoothPieces.hpp"

#include <algorithm>
#include <cassert>

namespace epafi::mesh {
namespace {

template <class Named>
std::vector<std::string> namesOf(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& entry : list)
    names.push_back(entry.name);
  return names;
}

template <class Named>
std::size_t placeOf(const std::string& name, const std::vector<Named>& list) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& entry) { return entry.name == name; });
  assert(found != list.end());
  return found - list.begin();
}

} // namespace

UnstructuredMesh::UnstructuredMesh(MeshArrays arrays)
    : arrays_(std::move(arrays)),
      topology_(arrays_.cellType, static_cast<LocalOrdinal>(arrays_.points.size()), arrays_.cells) {
  checkMesh(arrays_, topology_);
  if (dimensionOf(arrays_.cellType) == 2)
    for (Point& point : arrays_.points)
      point[2] = 0; // it is, but for rounding
  for (NamedFacets& surface : arrays_.surfaces) {
    findFacets(surface);
    surface.nodes = {};
  }
  for (NamedElements& group : arrays_.groups)
    std::sort(group.elements.begin(), group.elements.end());
  for (NamedNodes& set : arrays_.nodeSets)
    std::sort(set.nodes.begin(), set.nodes.end());
}

void UnstructuredMesh::findFacets(const NamedFacets& surface) {
  const auto perFacet = index(numCornersOf(facetTypeOf(arrays_.cellType)));
  std::vector<FacetPlace> facets;
  facets.reserve(surface.nodes.size() / perFacet);
  for (std::size_t i = 0; i < surface.nodes.size(); i += perFacet)
    facets.push_back(findFacet(
        surface.name, withoutFilling(std::span<const LocalOrdinal>(surface.nodes).subspan(i, perFacet))));
  std::sort(facets.begin(), facets.end());
  const auto copy = std::adjacent_find(facets.begin(), facets.end());
  if (copy != facets.end())
    throw InputError(
        arrays_.name + ": the surface \"" + surface.name + "\" lists a facet of element " +
        std::to_string(elementTag(copy->element)) +
        " twice; list it once (Gmsh writes it once per physical group in format 2.2, so save overlapping "
        "groups in format 4.1)");
  facets_.push_back(std::move(facets));
}

UnstructuredMesh::FacetPlace UnstructuredMesh::findFacet(const std::string& surface,
                                                         std::span<const LocalOrdinal> nodes) const {
  LocalOrdinal inside = -1;
  for (const LocalOrdinal element : topology_.elementsOf(nodes[0])) {
    const auto own = nodesOf(arrays_.cellType, arrays_.cells, element);
    const auto facets = facetsOf(withOrder(cellOf(arrays_.cellType, own.size()), 1));
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const bool isSame =
          facets[f].size() == nodes.size() && std::all_of(facets[f].begin(), facets[f].end(), [&](int place) {
            return std::find(nodes.begin(), nodes.end(), own[index(place)]) != nodes.end();
          });
      if (isSame && topology_.across(element, f) < 0)
        return {element, static_cast<std::uint8_t>(f)};
      if (isSame)
        inside = element;
    }
  }
  std::string text = arrays_.name + ": the surface \"" + surface + "\" has a facet with the nodes ";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(nodeTag(nodes[i]));
  if (inside >= 0)
    throw InputError(text + ", which lies inside the body, at element " + std::to_string(elementTag(inside)) +
                     "; a surface belongs to the boundary, so take this part out of the physical group");
  throw InputError(text + ", which is no facet of any element; mesh surface and body together");
}

void UnstructuredMesh::elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const {
  const auto own = rowOf(arrays_.cellType, arrays_.cells, element);
  std::copy(own.begin(), own.end(), nodes.begin());
}

void UnstructuredMesh::elementNodes(std::span<const GlobalOrdinal> elements,
                                    std::span<GlobalOrdinal> nodes) const {
  const auto count = index(nodesPerElement());
  for (std::size_t i = 0; i < elements.size(); ++i)
    elementNodes(elements[i], nodes.subspan(i * count, count));
}

void UnstructuredMesh::nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const {
  const auto own = topology_.elementsOf(node);
  elements.assign(own.begin(), own.end());
}

void UnstructuredMesh::numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    numbers[i] = static_cast<int>(topology_.elementsOf(nodes[i]).size());
}

void UnstructuredMesh::elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  for (std::size_t f = 0; f < facetsOf(arrays_.cellType).size(); ++f)
    if (const LocalOrdinal other = topology_.across(element, f); other >= 0)
      elements.push_back(other);
}

std::vector<std::string> UnstructuredMesh::surfaceNames() const {
  return namesOf(arrays_.surfaces);
}

Surface UnstructuredMesh::surface(const std::string& name) const {
  return name.empty() ? elementsAsSurface() : surfaceOf(facets_[placeOf(name, arrays_.surfaces)]);
}

Surface UnstructuredMesh::boundary() const {
  return surfaceOf(boundaryFacets());
}

/// Ascending.
std::vector<UnstructuredMesh::FacetPlace> UnstructuredMesh::boundaryFacets() const {
  std::vector<FacetPlace> facets;
  for (LocalOrdinal e = 0; e < arrays_.numElements(); ++e) {
    const auto own = nodesOf(arrays_.cellType, arrays_.cells, index(e));
    const std::size_t numFacets = facetsOf(cellOf(arrays_.cellType, own.size())).size();
    for (std::size_t f = 0; f < numFacets; ++f)
      if (topology_.across(index(e), f) < 0)
        facets.push_back({e, static_cast<std::uint8_t>(f)});
  }
  return facets;
}

void UnstructuredMesh::namePiece(const std::string& words) {
  const std::vector<std::string> names = surfaceNames();
  if (std::find(names.begin(), names.end(), words) != names.end())
    return;
  const auto pointAt = [&](GlobalOrdinal node) { return point(node); };
  const std::vector<FacetPlace> facets = boundaryFacets();
  const Surface all = surfaceOf(facets);
  const std::size_t nearest = nearestFacet(all, pointAt, placeIn(words).value());
  for (const std::vector<std::size_t>& piece : smoothPieces(all, pointAt)) {
    if (!std::binary_search(piece.begin(), piece.end(), nearest))
      continue;
    arrays_.surfaces.push_back({words, {}});
    facets_.emplace_back();
    for (const std::size_t facet : piece)
      facets_.back().push_back(facets[facet]);
  }
}

Surface UnstructuredMesh::surfaceOf(const std::vector<FacetPlace>& facets) const {
  Surface surface;
  surface.facetType = facetTypeOf(arrays_.cellType);
  for (const FacetPlace& facet : facets) {
    const auto nodes = nodesOf(arrays_.cellType, arrays_.cells, facet.element);
    std::vector<LocalOrdinal> own;
    for (const int node : facetsOf(cellOf(arrays_.cellType, nodes.size()))[facet.place])
      own.push_back(nodes[index(node)]);
    surface.add(own);
    surface.elements.push_back(facet.element);
  }
  return surface;
}

std::vector<std::string> UnstructuredMesh::groupNames() const {
  return namesOf(arrays_.groups);
}

std::vector<GlobalOrdinal> UnstructuredMesh::group(const std::string& name) const {
  const std::vector<LocalOrdinal>& elements = arrays_.groups[placeOf(name, arrays_.groups)].elements;
  return {elements.begin(), elements.end()};
}

std::vector<std::string> UnstructuredMesh::nodeSetNames() const {
  return namesOf(arrays_.nodeSets);
}

std::vector<GlobalOrdinal> UnstructuredMesh::nodeSet(const std::string& name) const {
  const std::vector<LocalOrdinal>& nodes = arrays_.nodeSets[placeOf(name, arrays_.nodeSets)].nodes;
  return {nodes.begin(), nodes.end()};
}

} // namespace epafi::mesh
