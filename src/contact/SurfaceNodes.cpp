#include "epafi/contact/SurfaceNodes.hpp"

#include "epafi/fem/ElementGeometry.hpp"

#include <algorithm>
#include <span>

namespace epafi::contact {

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
  std::vector<fem::Point> corners;
  std::vector<double> shares(static_cast<std::size_t>(surface.nodesPerFacet()));
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    mesh.pointsAt(nodes, corners);
    const Eigen::Vector3d normal = fem::areaVector(surface.facetType, corners);
    fem::nodalShares(surface.facetType, corners, shares);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
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

} // namespace epafi::contact
