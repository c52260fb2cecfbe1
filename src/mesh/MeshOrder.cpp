#include "epafi/mesh/MeshOrder.hpp"

#include "epafi/base/ArrayIndex.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace epafi::mesh {
namespace {

/// Adds the nodes element by element; what elements share is added once.
class Completion {
public:
  Completion(MeshArrays mesh, bool hasEdgeNodes, InnerNodes inner)
      : mesh_(std::move(mesh)), hasEdgeNodes_(hasEdgeNodes) {
    const CellType type = withOrder(mesh_.cellType, 2);
    given_ = mesh_.cellType = hasEdgeNodes ? withoutInnerNodes(type) : withOrder(type, 1);
    bool takesInner = inner == InnerNodes::added;
    for (std::size_t e = 0; dimensionOf(type) == 3 && e < index(mesh_.numElements()); ++e)
      takesInner = takesInner && nodesOf(given_, mesh_.cells, e).size() == index(numNodesOf(given_));
    mesh_.cellType = takesInner ? withInnerNodes(type) : withoutInnerNodes(type);
  }

  MeshArrays make() {
    const std::vector<LocalOrdinal> cells = std::exchange(mesh_.cells, {});
    const auto perElement = index(numNodesOf(mesh_.cellType));
    for (std::size_t e = 0; e * index(numNodesOf(given_)) < cells.size(); ++e) {
      const auto nodes = nodesOf(given_, cells, e);
      nodes_.assign(nodes.begin(), nodes.end());
      const CellType type = cellOf(given_, nodes.size());
      if (!hasEdgeNodes_)
        addEdgeNodes(edgesOf(type));
      if (mesh_.cellType == CellType::hexahedron27)
        addFaceNodes();
      if (nodes_.size() + 1 == perElement) // the largest one lacks its centre
        nodes_.push_back(addPoint(middle(nodes_, dimensionOf(mesh_.cellType))));
      mesh_.cells.insert(mesh_.cells.end(), nodes_.begin(), nodes_.end());
      fillRow(mesh_.cells, e * perElement, perElement);
    }
    return std::move(mesh_);
  }

private:
  LocalOrdinal addPoint(const Point& point) {
    mesh_.points.push_back(point);
    mesh_.nodeTags.push_back(-1);
    return static_cast<LocalOrdinal>(mesh_.points.size()) - 1;
  }

  void addEdgeNodes(std::span<const int> edges) {
    for (std::size_t e = 0; e < edges.size(); e += 2) {
      const auto ends = std::minmax(nodes_[index(edges[e])], nodes_[index(edges[e + 1])]);
      const auto [place, isNew] = onEdge_.try_emplace(ends, 0);
      if (isNew) {
        const Point &a = mesh_.points[index(ends.first)], &b = mesh_.points[index(ends.second)];
        place->second = addPoint({0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])});
      }
      nodes_.push_back(place->second);
    }
  }

  /// In the order −x +x −y +y −z +z, in which facetsOf() has the places of their nodes.
  void addFaceNodes() {
    constexpr std::size_t faces = 6, corners = 4, middles = 4, first = 20;
    const auto facets = facetsOf(CellType::hexahedron27);
    for (std::size_t face = 0; face < faces; ++face) {
      const auto facet = std::find_if(facets.begin(), facets.end(), [&](const Facet& candidate) {
        return index(candidate[corners + middles]) == first + face;
      });
      std::vector<LocalOrdinal> around;
      for (std::size_t i = 0; i < corners + middles; ++i)
        around.push_back(nodes_[index((*facet)[i])]);
      std::array<LocalOrdinal, corners> key{};
      std::copy_n(around.begin(), corners, key.begin());
      std::sort(key.begin(), key.end());
      const auto [place, isNew] = onFace_.try_emplace(key, 0);
      if (isNew)
        place->second = addPoint(middle(around, 2));
      nodes_.push_back(place->second);
    }
  }

  /// Where the Serendipity functions of corners and edges put the middle of a face or brick.
  [[nodiscard]] Point middle(const std::vector<LocalOrdinal>& nodes, int dimension) const {
    const std::size_t corners = dimension == 2 ? 4 : 8, edges = dimension == 2 ? 4 : 12;
    Point point{0, 0, 0};
    for (std::size_t i = 0; i < corners + edges; ++i)
      for (std::size_t d = 0; d < 3; ++d)
        point[d] +=
            (i < corners ? cornerInMiddle : edgeInMiddle(dimension)) * mesh_.points[index(nodes[i])][d];
    return point;
  }

  MeshArrays mesh_;
  CellType given_{}; ///< of the largest cells
  bool hasEdgeNodes_;
  std::vector<LocalOrdinal> nodes_; ///< of the cell at hand
  std::map<std::pair<LocalOrdinal, LocalOrdinal>, LocalOrdinal> onEdge_;
  std::map<std::array<LocalOrdinal, 4>, LocalOrdinal> onFace_;
};

} // namespace

MeshArrays completed(MeshArrays mesh, bool hasEdgeNodes, InnerNodes inner) {
  return Completion(std::move(mesh), hasEdgeNodes, inner).make();
}

MeshArrays linearised(MeshArrays mesh) {
  const auto perElement = index(numCornersOf(mesh.cellType));
  std::vector<LocalOrdinal> number(mesh.points.size(), -1);
  std::vector<LocalOrdinal> cells;
  for (std::size_t e = 0; e < index(mesh.numElements()); ++e) {
    const auto nodes = nodesOf(mesh.cellType, mesh.cells, e);
    for (const LocalOrdinal node : nodes.first(index(numCornersOf(cellOf(mesh.cellType, nodes.size()))))) {
      cells.push_back(node);
      number[index(node)] = 0;
    }
    fillRow(cells, e * perElement, perElement);
  }
  LocalOrdinal next = 0;
  for (std::size_t node = 0; node < number.size(); ++node)
    if (number[node] == 0) {
      mesh.points[index(next)] = mesh.points[node];
      mesh.nodeTags[index(next)] = mesh.nodeTags[node];
      number[node] = next++;
    }
  mesh.points.resize(index(next));
  mesh.nodeTags.resize(index(next));
  mesh.cellType = withOrder(mesh.cellType, 1);
  mesh.cells = std::move(cells);
  for (LocalOrdinal& node : mesh.cells)
    node = number[index(node)];
  for (NamedFacets& surface : mesh.surfaces)
    for (LocalOrdinal& node : surface.nodes)
      node = number[index(node)];
  for (NamedNodes& set : mesh.nodeSets) {
    for (LocalOrdinal& node : set.nodes)
      node = number[index(node)];
    std::erase(set.nodes, -1);
  }
  return mesh;
}

} // namespace epafi::mesh
