#include "epafi/decomposition/SurfaceNodes.hpp"

#include "epafi/fem/ElementGeometry.hpp"

#include <algorithm>
#include <span>

namespace epafi::decomposition {

SurfaceNodes surfaceNodes(const fem::Mesh& mesh, const fem::Surface& surface) {
  SurfaceNodes result;
  result.nodes = surface.facetNodes;
  std::sort(result.nodes.begin(), result.nodes.end());
  result.nodes.erase(std::unique(result.nodes.begin(), result.nodes.end()), result.nodes.end());
  for (const GlobalOrdinal node : result.nodes) {
    const fem::Point point = mesh.point(node);
    result.points.emplace_back(point[0], point[1], point[2]);
  }
  result.normals.assign(result.nodes.size(), Eigen::Vector3d::Zero());
  result.areas.assign(result.nodes.size(), 0.0);
  const auto perFacet = static_cast<std::size_t>(surface.nodesPerFacet);
  std::vector<fem::Point> corners(perFacet);
  for (std::size_t f = 0; f < surface.elements.size(); ++f) {
    const auto nodes = std::span(surface.facetNodes).subspan(f * perFacet, perFacet);
    std::transform(nodes.begin(), nodes.end(), corners.begin(),
                   [&](GlobalOrdinal node) { return mesh.point(node); });
    const Eigen::Vector3d normal = fem::areaVector(corners);
    const std::array<double, 4> shares = fem::nodalShares(corners);
    for (std::size_t a = 0; a < perFacet; ++a) {
      const auto place = static_cast<std::size_t>(
          std::lower_bound(result.nodes.begin(), result.nodes.end(), nodes[a]) - result.nodes.begin());
      result.normals[place] += normal;
      result.areas[place] += shares[a];
    }
  }
  for (Eigen::Vector3d& normal : result.normals)
    normal.normalize();
  return result;
}

} // namespace epafi::decomposition
