#include "epafi/contact/FacingFaces.hpp"

#include "epafi/contact/FacingNodes.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>

namespace epafi::contact {

using Eigen::Vector3d;

std::vector<char> faceOtherSide(const std::vector<MortarFacet>& facets, SurfaceNodes& nodes) {
  std::vector<char> isBent(nodes.nodes.size(), 0);
  std::vector<double> best(nodes.nodes.size(), 1.0);
  std::vector<const MortarFacet*> covered(nodes.facets.size(), nullptr);
  for (const MortarFacet& facet : facets) {
    covered[facet.facet] = &facet;
    for (const std::size_t k : nodes.facets[facet.facet].nodes)
      best[k] = std::min(best[k], facet.cosine);
  }
  std::map<std::size_t, std::vector<Vector3d>> facing; // at sharp bends
  const auto forEachSharp = [&](const auto& action) {
    for (std::size_t f = 0; f < covered.size(); ++f)
      for (const std::size_t k : nodes.facets[f].nodes)
        if (!nodes.faces[k].empty() && best[k] < 1)
          action(f, k);
  };
  forEachSharp([&](std::size_t f, std::size_t k) {
    if (covered[f] != nullptr && covered[f]->cosine <= best[k] + asGood)
      facing[k].push_back(nodes.facets[f].normal);
  });
  std::map<std::size_t, Vector3d> sums;
  std::map<std::size_t, bool> isAll;
  forEachSharp([&](std::size_t f, std::size_t k) {
    const Vector3d& normal = nodes.facets[f].normal;
    const auto continues = [&](const Vector3d& other) { return normal.dot(other) >= sharpBend; };
    const std::vector<Vector3d>& others = facing[k];
    const bool counts = std::any_of(others.begin(), others.end(), continues);
    isAll.try_emplace(k, true).first->second &= counts;
    if (!counts)
      return;
    isBent[k] = isBent[k] != 0 || !std::all_of(others.begin(), others.end(), continues) ? 1 : 0;
    const std::vector<double>& shares = nodes.facets[f].shares;
    sums.try_emplace(k, Vector3d::Zero()).first->second +=
        std::accumulate(shares.begin(), shares.end(), 0.0) * normal;
  });
  for (const auto& [k, sum] : sums)
    if (!isAll.at(k))
      nodes.normals[k] = sum.normalized();
  return isBent;
}

} // namespace epafi::contact
