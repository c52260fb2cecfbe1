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

inline std::vector<std::vector<int>> pieces(mesh::CellType type, bool simplices) {
  if (!simplices)
    return type == mesh::CellType::quadrilateral ? std::vector<std::vector<int>>{{0, 1, 2, 3}}
                                                 : std::vector<std::vector<int>>{{0, 1, 2, 3, 4, 5, 6, 7}};
  if (type == mesh::CellType::quadrilateral)
    return {{0, 1, 2}, {0, 2, 3}};
  std::vector<std::vector<int>> result;
  for (const auto& cut : tetrahedraOfCube())
    result.emplace_back(cut.begin(), cut.end());
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
    for (const mesh::Facet& facet : facetsOf(arrays.cellType)) {
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
        std::all_of(key.begin(), key.end(), [&](LocalOrdinal node) { return on.count(node) > 0; }))
      facets.nodes.insert(facets.nodes.end(), entry.second.begin(), entry.second.end());
  return facets;
}

/// A structured mesh as arrays with all its surfaces.
inline mesh::MeshArrays arraysOf(const mesh::Mesh& mesh, const Placement& placement, bool simplices) {
  mesh::MeshArrays arrays;
  arrays.name = "turned";
  const bool isPlane = mesh.cellType() == mesh::CellType::quadrilateral;
  arrays.cellType = !simplices ? mesh.cellType()
                    : isPlane  ? mesh::CellType::triangle
                               : mesh::CellType::tetrahedron;
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
    const Eigen::Vector3d x = placement.of(mesh.point(node));
    arrays.points.push_back({x[0], x[1], isPlane ? 0.0 : x[2]});
    arrays.nodeTags.push_back(node + 1);
  }
  std::vector<GlobalOrdinal> nodes(mesh.nodesPerElement());
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    mesh.elementNodes(element, nodes);
    for (const auto& piece : pieces(mesh.cellType(), simplices))
      for (const int corner : piece)
        arrays.cells.push_back(static_cast<LocalOrdinal>(nodes[corner]));
  }
  for (LocalOrdinal element = 0; element < arrays.numElements(); ++element)
    arrays.elementTags.push_back(element + 1);
  for (const std::string& name : mesh.surfaceNames())
    arrays.surfaces.push_back(facetsOn(mesh, name, arrays));
  return arrays;
}

/// By dimension and nodes.
inline int gmshTypeOf(std::size_t numNodes, int dimension) {
  static const std::map<std::pair<int, std::size_t>, int> types{
      {{1, 2}, 1},  {{2, 3}, 2},   {{2, 4}, 3},   {{3, 4}, 4},  {{3, 8}, 5},  {{2, 6}, 9},
      {{2, 9}, 10}, {{3, 10}, 11}, {{3, 27}, 12}, {{2, 8}, 16}, {{3, 20}, 17}};
  return types.at({dimension, numNodes});
}

/// Nodes of an element in Gmsh's order, by their places in ours; of Serendipity elements the first ones.
inline std::vector<std::size_t> gmshOrder(std::size_t numNodes, int dimension) {
  std::vector<std::size_t> order(numNodes);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (dimension == 3 && numNodes == 10)
    std::swap(order[8], order[9]);
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
  const auto write = [&](const std::vector<LocalOrdinal>& nodes, std::size_t number, int d,
                         std::size_t group) {
    for (std::size_t first = 0; first < nodes.size(); first += number) {
      elements << ++count << ' ' << gmshTypeOf(number, d) << " 2 " << group << ' ' << group;
      for (const std::size_t place : gmshOrder(number, d))
        elements << ' ' << nodes[first + place] + 1;
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
