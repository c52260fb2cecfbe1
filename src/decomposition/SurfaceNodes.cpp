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
    const double share = fem::facetMeasure(corners) / static_cast<double>(perFacet);
    for (const GlobalOrdinal node : nodes) {
      const auto place = static_cast<std::size_t>(
          std::lower_bound(result.nodes.begin(), result.nodes.end(), node) - result.nodes.begin());
      result.normals[place] += normal;
      result.areas[place] += share;
    }
  }
  for (Eigen::Vector3d& normal : result.normals)
    normal.normalize();
  return result;
}

} // namespace epafi::decomposition
