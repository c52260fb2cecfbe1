#include "epafi/decomposition/EdgeEnds.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>

namespace epafi::decomposition {
namespace {

using Numbers = std::vector<int>; ///< of subdomains, ascending

struct Edge {
  std::size_t carrier = 0;         ///< place of the node
  std::vector<Numbers> ends;       ///< who shares them, of all clusters
  std::vector<std::size_t> around; ///< places of the nodes of the faces there
};

/// Edges with averages by the subdomains of the cluster that share them.
using Edges = std::map<Numbers, Edge>;

Edges edgesOf(const SharedNodes& inside, const Crosspoints& crosspoints, SubdomainPlace s) {
  Edges edges;
  for (const EdgeAverage& average : crosspoints.averages(s)) {
    const std::span<const int> at = inside.subdomainsAt(inside.copy(*inside.find(s, average.carrier)).node);
    edges[{at.begin(), at.end()}].carrier = average.carrier;
  }
  return edges;
}

/// \param isOutside  whether a subdomain belongs to another cluster
template <class IsOutside>
void findEnds(const SharedNodes& shared, SubdomainPlace s, const IsOutside& isOutside, Edges& edges) {
  for (const SharedNodes::Copy& copy : shared.copiesOf(s)) {
    const std::span<const int> at = shared.subdomainsAt(copy.node);
    Numbers ofCluster;
    std::remove_copy_if(at.begin(), at.end(), std::back_inserter(ofCluster), isOutside);
    if (const auto edge = edges.find(ofCluster); edge != edges.end() && ofCluster.size() < at.size())
      edge->second.ends.emplace_back(at.begin(), at.end());
  }
  for (const SharedNodes::Copy& copy : shared.copiesOf(s)) {
    const std::span<const int> at = shared.subdomainsAt(copy.node);
    if (std::none_of(at.begin(), at.end(), isOutside))
      continue;
    for (auto& [inCluster, edge] : edges)
      if (std::any_of(edge.ends.begin(), edge.ends.end(), [at](const Numbers& end) {
            return std::includes(end.begin(), end.end(), at.begin(), at.end());
          }))
        edge.around.push_back(copy.place);
  }
}

} // namespace

std::vector<EdgeEnd> findEdgeEnds(const Substructures& all, const SharedNodes& inside,
                                  const SharedNodes& shared, std::span<const int> clusterOf,
                                  const Crosspoints& crosspoints, SubdomainPlace subdomain) {
  Edges edges = edgesOf(inside, crosspoints, subdomain);
  const int own = clusterOf[all.subdomains[subdomain].number];
  findEnds(
      shared, subdomain, [&](int number) { return clusterOf[number] != own; }, edges);
  std::vector<EdgeEnd> result;
  for (const auto& [subdomains, edge] : edges) {
    const double share = 1.0 / static_cast<double>(subdomains.size() * edge.around.size());
    const std::span<const int> averages = all.unknownsAt(subdomain, edge.carrier);
    for (const std::size_t node : edge.around) {
      GlobalOrdinal index = crosspoints.firstIndex(all.globalNode(subdomain, edge.carrier));
      for (int c = 0; c < all.components; ++c) {
        if (averages[c] < 0)
          continue;
        if (const int unknown = all.unknownsAt(subdomain, node)[c]; unknown >= 0)
          result.push_back({unknown, CoarseNumber(index), share});
        ++index;
      }
    }
  }
  return result;
}

} // namespace epafi::decomposition
