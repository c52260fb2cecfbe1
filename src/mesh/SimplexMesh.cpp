#include "epafi/mesh/SimplexMesh.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <algorithm>
#include <map>
#include <span>

namespace epafi::mesh {
namespace {

/// Sets of numbers, each by its place in a list.
class Marks {
public:
  explicit Marks(std::vector<std::vector<int>>& sets) : sets_(sets) {}

  void add(int& mark, int number) {
    std::vector<int> set = sets_[index(mark)];
    set.push_back(number);
    const auto [place, isNew] = places_.try_emplace(set, static_cast<int>(sets_.size()));
    if (isNew)
      sets_.push_back(std::move(set));
    mark = place->second;
  }

private:
  std::vector<std::vector<int>>& sets_;
  std::map<std::vector<int>, int> places_;
};

/// Corners of the simplices that a cell is cut into, as places among its own corners.
using Pieces = std::vector<std::array<int, 4>>;

/// A cone over what does not touch its lowest corner.
Pieces cut(CellType type, std::span<const GlobalOrdinal> corners) {
  if (type == CellType::triangle || type == CellType::tetrahedron)
    return {{0, 1, 2, 3}};
  const auto lowest = [&](auto begin, auto end) {
    return std::min_element(begin, end, [&](int a, int b) { return corners[index(a)] < corners[index(b)]; });
  };
  const auto tip = static_cast<int>(std::min_element(corners.begin(), corners.end()) - corners.begin());
  if (type == CellType::quadrilateral)
    return {{tip, (tip + 1) % 4, (tip + 2) % 4, 0}, {tip, (tip + 2) % 4, (tip + 3) % 4, 0}};
  Pieces pieces;
  for (const Facet& face : facetsOf(type)) {
    if (std::find(face.begin(), face.end(), tip) != face.end())
      continue;
    const auto first = index(lowest(face.begin(), face.end()) - face.begin());
    const auto at = [&](std::size_t i) { return face[(first + i) % face.size()]; };
    for (std::size_t i = 1; i + 1 < face.size(); ++i) // seen from outside; the tip lies behind
      pieces.push_back({at(0), at(i + 1), at(i), tip});
  }
  return pieces;
}

/// Cuts cell by cell.
class Cutting {
public:
  explicit Cutting(const Mesh& mesh) : mesh_(mesh) {
    result_.dimension = dimensionOf(mesh.cellType());
    result_.surfaces = mesh.surfaceNames();
    result_.groups = mesh.groupNames();
    const auto* unstructured = dynamic_cast<const UnstructuredMesh*>(&mesh);
    result_.name = unstructured == nullptr ? "The mesh" : unstructured->name();
  }

  SimplexMesh make() {
    numberCorners();
    for (GlobalOrdinal cell = 0; cell < mesh_.numElements(); ++cell)
      addCell(cell);
    markGroups();
    for (int s = 0; s < std::ssize(result_.surfaces); ++s)
      markSurface(s);
    return std::move(result_);
  }

private:
  /// In the order of the mesh's own numbers.
  void numberCorners() {
    std::vector<char> isCorner(index(mesh_.numNodes()), 0);
    for (GlobalOrdinal cell = 0; cell < mesh_.numElements(); ++cell) {
      const ElementNodes nodes(mesh_, cell);
      for (std::size_t i = 0; i < index(numCornersOf(nodes.type())); ++i)
        isCorner[index(nodes[i])] = 1;
    }
    number_.assign(isCorner.size(), -1);
    for (std::size_t node = 0; node < isCorner.size(); ++node)
      if (isCorner[node] != 0) {
        number_[node] = static_cast<LocalOrdinal>(result_.points.size());
        result_.points.push_back(mesh_.point(node));
      }
  }

  void addCell(GlobalOrdinal cell) {
    const ElementNodes nodes(mesh_, cell);
    const std::span<const GlobalOrdinal> all(nodes.begin(), nodes.size());
    first_.push_back(result_.elements.size());
    const CellType linear = withOrder(nodes.type(), 1);
    std::vector<Point> points;
    mesh_.elementPoints(cell, points);
    for (const std::array<int, 4>& piece : cut(linear, all.first(index(numCornersOf(linear))))) {
      SimplexMesh::Element element;
      const auto count = index(result_.dimension) + 1;
      for (std::size_t i = 0; i < count; ++i)
        element.corners[i] = number_[index(nodes[index(piece[i])])];
      result_.elements.push_back(element);
      for (std::size_t i = 0; linear != nodes.type() && i < count; ++i)
        for (std::size_t j = 0; j < i; ++j)
          addBend(nodes, points, {piece[i], piece[j]});
    }
  }

  /// Of an edge of the cell, or of a diagonal of a face or through it.
  void addBend(const ElementNodes& nodes, std::span<const Point> points, const std::array<int, 2>& ends) {
    const Point &a = points[index(ends[0])], &b = points[index(ends[1])];
    const Point m = withShape(nodes.type(), [&](const auto& shape) {
      const NodalValues values = shape.values(0.5 * (shape.node(ends[0]) + shape.node(ends[1])));
      Point middle{};
      for (std::size_t node = 0; node < points.size(); ++node)
        for (std::size_t d = 0; d < 3; ++d)
          middle[d] += values[static_cast<Eigen::Index>(node)] * points[node][d];
      return middle;
    });
    Point bend{};
    double size = 0, length = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      bend[d] = m[d] - 0.5 * (a[d] + b[d]);
      size = std::max(size, std::abs(bend[d]));
      length = std::max(length, std::abs(b[d] - a[d]));
    }
    constexpr double roundOff = 1e-10;
    if (size > roundOff * length)
      result_.bends[SimplexMesh::edgeBetween(number_[index(nodes[index(ends[0])])],
                                             number_[index(nodes[index(ends[1])])])] = bend;
  }

  /// The pieces of a cell.
  [[nodiscard]] std::span<SimplexMesh::Element> piecesOf(GlobalOrdinal cell) {
    const std::size_t begin = first_[index(cell)], end = index(cell) + 1 < first_.size()
                                                             ? first_[index(cell) + 1]
                                                             : result_.elements.size();
    return std::span(result_.elements).subspan(begin, end - begin);
  }

  void markGroups() {
    Marks marks(result_.groupMarks);
    for (int g = 0; g < std::ssize(result_.groups); ++g)
      for (const GlobalOrdinal cell : mesh_.group(result_.groups[g]))
        for (SimplexMesh::Element& element : piecesOf(cell))
          marks.add(element.group, g);
  }

  void markSurface(int number) {
    Marks marks(result_.facetMarks);
    const Surface surface = mesh_.surface(result_.surfaces[index(number)]);
    std::vector<LocalOrdinal> corners;
    const std::size_t count = index(result_.dimension) + 1;
    for (std::size_t f = 0; f < surface.numFacets(); ++f) {
      corners.clear();
      for (const GlobalOrdinal node : surface.corners(f))
        corners.push_back(number_[index(node)]);
      const auto isOn = [&](LocalOrdinal node) {
        return std::find(corners.begin(), corners.end(), node) != corners.end();
      };
      for (SimplexMesh::Element& element : piecesOf(surface.elements[f]))
        for (std::size_t opposite = 0; opposite < count; ++opposite) {
          bool isInside = true;
          for (std::size_t i = 0; i < count; ++i)
            isInside = isInside && (i == opposite || isOn(element.corners[i]));
          if (isInside)
            marks.add(element.facets[opposite], number);
        }
    }
  }

  const Mesh& mesh_;
  SimplexMesh result_;
  std::vector<LocalOrdinal> number_; ///< of each node of the mesh, if it is a corner
  std::vector<std::size_t> first_;   ///< piece of each cell
};

/// Places of a simplex's corners round the facet opposite to one of them.
std::span<const int> cornersOpposite(int dimension, int corner) {
  const CellType type = dimension == 2 ? CellType::triangle : CellType::tetrahedron;
  for (const Facet& facet : facetsOf(type))
    if (std::find(facet.begin(), facet.end(), corner) == facet.end())
      return facet.nodes;
  return {};
}

void addSurfaces(const SimplexMesh& mesh, MeshArrays& arrays) {
  for (const std::string& name : mesh.surfaces)
    arrays.surfaces.push_back({name, {}});
  for (const SimplexMesh::Element& element : mesh.elements)
    for (int opposite = 0; opposite <= mesh.dimension; ++opposite)
      for (const int surface : mesh.facetMarks[index(element.facets[opposite])])
        for (const int place : cornersOpposite(mesh.dimension, opposite))
          arrays.surfaces[index(surface)].nodes.push_back(element.corners[index(place)]);
}

void bendEdges(const SimplexMesh& mesh, MeshArrays& arrays) {
  const std::span<const int> edges = edgesOf(arrays.cellType);
  const auto count = index(numNodesOf(arrays.cellType));
  std::vector<char> isBent(arrays.points.size(), 0);
  for (std::size_t cell = 0; cell < mesh.elements.size(); ++cell)
    for (std::size_t e = 0; e < edges.size(); e += 2) {
      const auto& corners = mesh.elements[cell].corners;
      const auto bend =
          mesh.bends.find(SimplexMesh::edgeBetween(corners[index(edges[e])], corners[index(edges[e + 1])]));
      const LocalOrdinal node = arrays.cells[cell * count + index(mesh.dimension) + 1 + e / 2];
      if (bend == mesh.bends.end() || std::exchange(isBent[index(node)], 1) != 0)
        continue;
      for (std::size_t d = 0; d < 3; ++d)
        arrays.points[index(node)][d] += bend->second[d];
    }
}

} // namespace

bool isOfSimplices(const Mesh& mesh) {
  const CellType type = withOrder(mesh.cellType(), 1);
  return type == CellType::triangle || type == CellType::tetrahedron;
}

SimplexMesh simplicesOf(const Mesh& mesh) {
  return Cutting(mesh).make();
}

MeshArrays arraysOf(const SimplexMesh& mesh, int order) {
  MeshArrays arrays;
  arrays.name = mesh.name;
  arrays.cellType = mesh.dimension == 2 ? CellType::triangle : CellType::tetrahedron;
  arrays.points = mesh.points;
  for (const std::string& name : mesh.groups)
    arrays.groups.push_back({name, {}});
  arrays.cells.reserve(mesh.elements.size() * (index(mesh.dimension) + 1));
  for (LocalOrdinal e = 0; e < std::ssize(mesh.elements); ++e) {
    const SimplexMesh::Element& element = mesh.elements[e];
    arrays.cells.insert(arrays.cells.end(), element.corners.begin(),
                        element.corners.begin() + mesh.dimension + 1);
    arrays.elementTags.push_back(e);
    for (const int group : mesh.groupMarks[index(element.group)])
      arrays.groups[index(group)].elements.push_back(e);
  }
  for (std::size_t node = 0; node < arrays.points.size(); ++node)
    arrays.nodeTags.push_back(node);
  addSurfaces(mesh, arrays);
  std::erase_if(arrays.surfaces, [](const NamedFacets& surface) { return surface.nodes.empty(); });
  if (order == 1)
    return arrays;
  arrays = completed(std::move(arrays), false);
  if (!mesh.bends.empty())
    bendEdges(mesh, arrays);
  return arrays;
}

} // namespace epafi::mesh
