#pragma once

/// Structured meshes as arrays, turned, shifted and cut into simplices, and their files.

#include "epafi/mesh/MeshArrays.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace epafi::test {

/// x ↦ Qx + shift.
struct Placement {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift{0, 0, 0};

  [[nodiscard]] Eigen::Vector3d of(const Point& point) const {
    return turn * Eigen::Vector3d(point[0], point[1], point[2]) + shift;
  }
};

inline Placement placed(int dimension, double angle, const Eigen::Vector3d& shift) {
  const Eigen::Vector3d axis =
      dimension == 2 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(1, 2, -0.5).normalized();
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), shift};
}

/// The six tetrahedra of a hexahedron around its diagonal, of four corners each; neighbours fit.
inline const std::vector<std::array<int, 4>>& tetrahedraOfCube() {
  static const std::vector<std::array<int, 4>> cut{{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                                   {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  return cut;
}

/// What the squares or cubes of a grid become: themselves, triangles or six tetrahedra, two prisms, six
/// pyramids about a node in the middle, or one of these after the other, column by column: sides of columns
/// are squares.
enum class Cut { none, simplices, prisms, pyramids, mixed };

/// Six pyramids, those below and above cut into two tetrahedra each if so asked.
inline std::vector<std::vector<int>> pyramidsOfCube(bool areCut) {
  std::vector<std::vector<int>> result;
  for (const mesh::Facet& face : mesh::facetsOf(mesh::CellType::hexahedron)) {
    const std::array<int, 4> base{face[0], face[3], face[2], face[1]};
    if (areCut && result.size() < 4) {
      result.push_back({base[0], base[1], base[2], 8});
      result.push_back({base[0], base[2], base[3], 8});
    } else {
      result.push_back({base[0], base[1], base[2], base[3], 8});
    }
  }
  return result;
}

/// Corners of the pieces of a square or cube; 8: its middle.
inline std::vector<std::vector<int>> pieces(mesh::CellType type, Cut cut, int column = 0) {
  const bool isPlane = type == mesh::CellType::quadrilateral;
  if (cut == Cut::mixed && !isPlane && column % 4 == 3)
    return pyramidsOfCube(true);
  if (cut == Cut::mixed)
    cut = isPlane ? std::array{Cut::none, Cut::simplices}.at(column % 2)
                  : std::array{Cut::none, Cut::prisms, Cut::pyramids}.at(column % 4);
  if (cut == Cut::none)
    return isPlane ? std::vector<std::vector<int>>{{0, 1, 2, 3}}
                   : std::vector<std::vector<int>>{{0, 1, 2, 3, 4, 5, 6, 7}};
  if (isPlane)
    return {{0, 1, 2}, {0, 2, 3}};
  if (cut == Cut::prisms)
    return {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
  if (cut == Cut::pyramids)
    return pyramidsOfCube(false);
  std::vector<std::vector<int>> result;
  for (const auto& tetrahedron : tetrahedraOfCube())
    result.emplace_back(tetrahedron.begin(), tetrahedron.end());
  return result;
}

/// Boundary facets all of whose nodes belong to a surface of the structured mesh.
inline mesh::NamedFacets facetsOn(const mesh::Mesh& mesh, const std::string& name,
                                  const mesh::MeshArrays& arrays) {
  const mesh::Surface surface = mesh.surface(name);
  const std::set<GlobalOrdinal> on(surface.facetNodes.begin(), surface.facetNodes.end());
  std::map<std::vector<LocalOrdinal>, std::pair<int, std::vector<LocalOrdinal>>>
      seen; // sorted: count, ordered
  for (LocalOrdinal e = 0; e < arrays.numElements(); ++e) {
    const auto nodes = nodesOf(arrays.cellType, arrays.cells, e);
    for (const mesh::Facet& facet : facetsOf(cellOf(arrays.cellType, nodes.size()))) {
      std::vector<LocalOrdinal> own;
      for (const int place : facet)
        own.push_back(nodes[place]);
      std::vector<LocalOrdinal> key = own;
      std::sort(key.begin(), key.end());
      auto& entry = seen[key];
      ++entry.first;
      entry.second = own;
    }
  }
  mesh::NamedFacets facets{name, {}};
  for (const auto& [key, entry] : seen)
    if (entry.first == 1 &&
        std::all_of(key.begin(), key.end(), [&](LocalOrdinal node) { return on.count(node) > 0; })) {
      const std::size_t first = facets.nodes.size();
      facets.nodes.insert(facets.nodes.end(), entry.second.begin(), entry.second.end());
      mesh::fillRow(facets.nodes, first, numCornersOf(facetTypeOf(arrays.cellType)));
    }
  return facets;
}

/// A structured mesh as arrays with all its surfaces.
inline mesh::MeshArrays arraysOf(const mesh::Mesh& mesh, const Placement& placement, Cut cut) {
  mesh::MeshArrays arrays;
  arrays.name = "turned";
  const bool isPlane = mesh.cellType() == mesh::CellType::quadrilateral;
  const std::array types{mesh.cellType(), isPlane ? mesh::CellType::triangle : mesh::CellType::tetrahedron,
                         isPlane ? mesh::CellType::triangle : mesh::CellType::prism, mesh::CellType::pyramid,
                         mesh.cellType()};
  arrays.cellType = types.at(static_cast<std::size_t>(cut));
  const auto add = [&](const Point& point) {
    const Eigen::Vector3d x = placement.of(point);
    arrays.points.push_back({x[0], x[1], isPlane ? 0.0 : x[2]});
    arrays.nodeTags.push_back(static_cast<GlobalOrdinal>(arrays.points.size()));
  };
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    add(mesh.point(node));
  const mesh::StructuredMesh* grid = mesh.structured();
  std::vector<GlobalOrdinal> nodes(mesh.nodesPerElement() + 1);
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    mesh.elementNodes(element, nodes);
    const GlobalOrdinal inX = grid == nullptr ? 1 : grid->elements()[0],
                        inY = grid == nullptr ? 1 : grid->elements()[1];
    const auto cells = pieces(mesh.cellType(), cut, static_cast<int>(element % inX + element / inX % inY));
    if (cells.size() > 2 && cells.back().back() == 8) {
      nodes[8] = std::ssize(arrays.points);
      Point middle{};
      for (int corner = 0; corner < 8; ++corner)
        for (std::size_t d = 0; d < 3; ++d)
          middle[d] += mesh.point(nodes[corner])[d] / 8;
      add(middle);
    }
    for (const auto& piece : cells) {
      const std::size_t first = arrays.cells.size();
      for (const int corner : piece)
        arrays.cells.push_back(static_cast<LocalOrdinal>(nodes[corner]));
      mesh::fillRow(arrays.cells, first, numNodesOf(arrays.cellType));
    }
  }
  for (LocalOrdinal element = 0; element < arrays.numElements(); ++element)
    arrays.elementTags.push_back(element + 1);
  for (const std::string& name : mesh.surfaceNames())
    arrays.surfaces.push_back(facetsOn(mesh, name, arrays));
  return arrays;
}

inline mesh::MeshArrays arraysOf(const mesh::Mesh& mesh, const Placement& placement, bool simplices) {
  return arraysOf(mesh, placement, simplices ? Cut::simplices : Cut::none);
}

/// By dimension and nodes.
inline int gmshTypeOf(std::size_t numNodes, int dimension) {
  static const std::map<std::pair<int, std::size_t>, int> types{
      {{1, 2}, 1},   {{2, 3}, 2},  {{2, 4}, 3},   {{3, 4}, 4},   {{3, 8}, 5},
      {{2, 6}, 9},   {{2, 9}, 10}, {{3, 10}, 11}, {{3, 27}, 12}, {{2, 8}, 16},
      {{3, 20}, 17}, {{3, 6}, 6},  {{3, 5}, 7},   {{3, 15}, 18}, {{3, 13}, 19}};
  return types.at({dimension, numNodes});
}

/// Nodes of an element in Gmsh's order, by their places in ours; of Serendipity elements the first ones.
inline std::vector<std::size_t> gmshOrder(std::size_t numNodes, int dimension) {
  std::vector<std::size_t> order(numNodes);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (dimension == 3 && numNodes == 10)
    std::swap(order[8], order[9]);
  if (dimension == 3 && numNodes == 15) { // edges 01 02 03 12 14 25 34 35 45
    const std::array<std::size_t, 9> behindCorners{6, 8, 12, 7, 13, 14, 9, 11, 10};
    std::copy(behindCorners.begin(), behindCorners.end(), order.begin() + 6);
  }
  if (dimension == 3 && numNodes == 13) { // edges 01 03 04 12 14 23 24 34
    const std::array<std::size_t, 8> behindCorners{5, 8, 9, 6, 10, 7, 11, 12};
    std::copy(behindCorners.begin(), behindCorners.end(), order.begin() + 5);
  }
  if (dimension == 3 && numNodes >= 20) { // edges 01 03 04 12 15 23 26 37 45 47 56 67, faces z y x X Y Z
    const std::array<std::size_t, 19> behindCorners{8,  11, 16, 9,  17, 10, 18, 19, 12, 15,
                                                    13, 14, 24, 22, 20, 21, 23, 25, 26};
    std::copy_n(behindCorners.begin(), numNodes - 8, order.begin() + 8);
  }
  return order;
}

/// A file of format 2.2 with one group for the body and one for each surface.
/// \param perElement  nodes of the cells; 0: as their type has
inline std::string fileOf(const mesh::MeshArrays& arrays, std::size_t perElement = 0) {
  const int dimension = dimensionOf(arrays.cellType);
  std::ostringstream file;
  file.precision(17);
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << arrays.surfaces.size() + 1 << '\n';
  file << dimension << " 1 \"body\"\n";
  for (std::size_t s = 0; s < arrays.surfaces.size(); ++s)
    file << dimension - 1 << ' ' << s + 2 << " \"" << arrays.surfaces[s].name << "\"\n";
  file << "$EndPhysicalNames\n$Nodes\n" << arrays.points.size() << '\n';
  for (std::size_t n = 0; n < arrays.points.size(); ++n)
    file << n + 1 << ' ' << arrays.points[n][0] << ' ' << arrays.points[n][1] << ' ' << arrays.points[n][2]
         << '\n';
  std::ostringstream elements;
  std::size_t count = 0;
  const auto write = [&](const std::vector<LocalOrdinal>& nodes, std::size_t length, int d,
                         std::size_t group) {
    for (std::size_t first = 0; first < nodes.size(); first += length) {
      const auto own = mesh::withoutFilling(std::span<const LocalOrdinal>(nodes).subspan(first, length));
      elements << ++count << ' ' << gmshTypeOf(own.size(), d) << " 2 " << group << ' ' << group;
      for (const std::size_t place : gmshOrder(own.size(), d))
        elements << ' ' << own[place] + 1;
      elements << '\n';
    }
  };
  const std::size_t perFacet = numCornersOf(facetTypeOf(arrays.cellType));
  for (std::size_t s = 0; s < arrays.surfaces.size(); ++s)
    write(arrays.surfaces[s].nodes, perFacet, dimension - 1, s + 2);
  write(arrays.cells, perElement > 0 ? perElement : static_cast<std::size_t>(numNodesOf(arrays.cellType)),
        dimension, 1);
  file << "$EndNodes\n$Elements\n" << count << '\n' << elements.str() << "$EndElements\n";
  return file.str();
}

} // namespace epafi::test
