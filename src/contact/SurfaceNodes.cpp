#include "epafi/contact/SurfaceNodes.hpp"

#include "epafi/fem/ElementGeometry.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
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
  result.spacings.assign(result.nodes.size(), 0.0);
  std::vector<fem::Point> corners;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> shares(static_cast<std::size_t>(surface.nodesPerFacet()));
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    mesh.pointsAt(nodes, corners);
    fem::nodalNormals(surface.facetType, corners, normals);
    fem::nodalShares(surface.facetType, corners, shares);
    const double even =
        std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size());
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const auto place = static_cast<std::size_t>(
          std::lower_bound(result.nodes.begin(), result.nodes.end(), nodes[a]) - result.nodes.begin());
      result.normals[place] += normals[a];
      result.areas[place] += shares[a];
      result.spacings[place] += even;
    }
  }
  for (Eigen::Vector3d& normal : result.normals)
    normal.normalize();
  if (dimensionOf(surface.facetType) == 2)
    for (double& spacing : result.spacings)
      spacing = std::sqrt(spacing);
  return result;
}

} // namespace epafi::contact
