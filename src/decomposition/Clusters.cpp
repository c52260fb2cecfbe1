#include "epafi/decomposition/Clusters.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/Corners.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace epafi::decomposition {
namespace {

/// Subdomains of one cluster that hold each other: this rank's with higher ones, at free nodes that no other
/// cluster has.
std::vector<Link> linksOf(const Substructures& all, const SharedNodes& shared,
                          std::span<const int> clusterOf) {
  const auto cluster = [&](int number) { return clusterOf[number]; };
  std::vector<Link> links;
  for (std::size_t s = 0; s < all.size(); ++s) {
    const int own = all.subdomains[s].number;
    std::map<int, HoldingPoints> points; // of each higher neighbour
    for (const SharedNodes::Copy& copy : shared.copiesOf(s)) {
      const std::span<const int> at = shared.subdomainsAt(copy.node);
      if (!all.isFree(s, copy.place) ||
          !std::all_of(at.begin(), at.end(), [&](int number) { return cluster(number) == cluster(own); }))
        continue;
      for (const int other : at.subspan(copy.order + 1))
        points.try_emplace(other, all.components).first->second.add(all.point(s, copy.place));
    }
    for (const auto& [other, holding] : points)
      if (holding.hold())
        links.push_back({own, other});
  }
  return links;
}

/// Σ (R^s)ᵀ A^s over the subdomains of each cluster, on every rank. Collective.
std::vector<Eigen::MatrixXd> clusterSums(const Comm& comm, const std::vector<Motions>& motions,
                                         const std::vector<Eigen::MatrixXd>& kernels,
                                         const std::vector<Cluster>& clusters,
                                         const std::vector<Eigen::Index>& columns,
                                         const std::function<const Eigen::MatrixXd&(std::size_t)>& factor) {
  std::vector<std::size_t> first(1, 0);
  for (std::size_t c = 0; c < clusters.size(); ++c)
    first.push_back(first.back() + clusters[c].kernelDimension * columns[c]);
  std::vector<double> values(first.back(), 0.0);
  const auto sum = [&](std::size_t c) {
    return Eigen::Map<Eigen::MatrixXd>(values.data() + first[c], clusters[c].kernelDimension, columns[c]);
  };
  for (std::size_t s = 0; s < kernels.size(); ++s)
    sum(motions[s].group) += kernels[s].transpose() * factor(s);
  sumOverRanks(comm, std::span<double>(values));
  std::vector<Eigen::MatrixXd> sums;
  for (std::size_t c = 0; c < clusters.size(); ++c)
    sums.emplace_back(sum(c));
  return sums;
}

} // namespace

std::vector<int> piecesOf(std::size_t numSubdomains, std::span<const Link> links) {
  std::vector<std::size_t> root(numSubdomains);
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&root](std::size_t s) {
    while (root[s] != s)
      s = root[s] = root[root[s]];
    return s;
  };
  for (const Link& link : links) {
    const std::size_t a = find(link.subdomain), b = find(link.other);
    root[std::max(a, b)] = std::min(a, b);
  }
  std::vector<int> piece(numSubdomains);
  int next = 0;
  for (std::size_t s = 0; s < numSubdomains; ++s)
    piece[s] = find(s) == s ? next++ : piece[find(s)];
  return piece;
}

std::vector<int> findClusters(const Substructures& all, const SharedNodes& shared,
                              std::span<const int> sizes) {
  std::vector<int> clusterOf; // first the bodies
  for (std::size_t s = 0; s < all.size(); ++s)
    clusterOf.push_back(all.subdomains[s].body);
  clusterOf = gatherOnAll(*all.comm, clusterOf); // subdomains are numbered rank by rank
  if (std::all_of(sizes.begin(), sizes.end(), [](int size) { return size == 0; }))
    return clusterOf;
  std::vector<int> count(all.bodies.size(), 0), first(all.bodies.size(), 0); // first of the run
  std::vector<Link> whole; // what is not to be cut, whatever holds it
  int next = 0;
  for (int s = 0; s < std::ssize(clusterOf); ++s) {
    const std::size_t body = clusterOf[s];
    const int number = count[body]++;
    if (number == 0 || (sizes[body] > 0 && number % sizes[body] == 0)) {
      first[body] = s;
      clusterOf[s] = next++;
      continue;
    }
    clusterOf[s] = clusterOf[first[body]];
    if (sizes[body] == 0)
      whole.push_back({first[body], s});
  }
  for (int before = 0; before != next;) { // a cut takes nodes away from what it leaves
    before = next;
    std::vector<Link> links = gatherOnAll(*all.comm, linksOf(all, shared, clusterOf));
    links.insert(links.end(), whole.begin(), whole.end());
    clusterOf = piecesOf(clusterOf.size(), links);
    next = clusterOf.empty() ? 0 : 1 + *std::max_element(clusterOf.begin(), clusterOf.end());
  }
  return clusterOf;
}

std::vector<Cluster> clustersOfBodies(std::span<const Body> bodies) {
  std::vector<Cluster> clusters;
  for (int b = 0; b < std::ssize(bodies); ++b)
    clusters.push_back({b, bodies[b].kernelDimension, bodies[b].kernelOffset,
                        Eigen::MatrixXd::Identity(bodies[b].kernelDimension, bodies[b].kernelDimension)});
  return clusters;
}

ClusterKernels findClusterKernels(const Substructures& all, std::vector<Motions> motions,
                                  const std::vector<int>& clusterOf) {
  ClusterKernels result;
  result.clusters.resize(clusterOf.empty() ? 0 : 1 + *std::max_element(clusterOf.begin(), clusterOf.end()));
  std::vector<int> bodies;
  for (std::size_t s = 0; s < all.size(); ++s)
    bodies.push_back(all.subdomains[s].body);
  bodies = gatherOnAll(*all.comm, bodies);
  for (std::size_t s = 0; s < bodies.size(); ++s)
    result.clusters[clusterOf[s]].body = bodies[s];
  for (std::size_t s = 0; s < motions.size(); ++s)
    motions[s].group = clusterOf[all.subdomains[s].number];
  const std::vector<Eigen::MatrixXd> free = findFreeMotions(motions, *all.comm, result.clusters.size());
  std::vector<Eigen::Index> own, ofBody; // numbers of modes
  int offset = 0;
  for (std::size_t c = 0; c < free.size(); ++c) {
    Cluster& cluster = result.clusters[c];
    cluster.kernelDimension = static_cast<int>(free[c].cols());
    cluster.kernelOffset = offset;
    offset += cluster.kernelDimension;
    own.push_back(cluster.kernelDimension);
    ofBody.push_back(all.bodies[cluster.body].kernelDimension);
  }
  for (const Motions& m : motions)
    result.kernels.emplace_back(m.near * free[m.group]);
  const auto sums = [&](const std::vector<Eigen::Index>& columns, const auto& factor) {
    return clusterSums(*all.comm, motions, result.kernels, result.clusters, columns, factor);
  };
  const auto gram = sums(own, [&](std::size_t s) -> const Eigen::MatrixXd& { return result.kernels[s]; });
  const auto mixed =
      sums(ofBody, [&](std::size_t s) -> const Eigen::MatrixXd& { return all.subdomains[s].kernel; });
  for (std::size_t c = 0; c < free.size(); ++c) { // R X = R_body, but for round-off
    result.clusters[c].ofBody = mixed[c];
    if (result.clusters[c].kernelDimension > 0)
      result.clusters[c].ofBody = direct::solvedSymmetric(gram[c], mixed[c]);
  }
  return result;
}

} // namespace epafi::decomposition
