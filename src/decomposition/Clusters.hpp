#pragma once

/// Which subdomains share crosspoints, and how they move together.
///
/// A *cluster* is a whole body (FETI-DP), one subdomain (FETI with its natural coarse space: Farhat, Mandel,
/// Roux, *Comput. Methods Appl. Mech. Engrg.* 115 (1994)) or several that hang together (hybrid: Klawonn,
/// Rheinbach, *ZAMM* 90 (2010); Kozubek et al., *Adv. Eng. Softw.* 60–61 (2013)). Crosspoints and averages
/// join the subdomains of one cluster alone; between clusters there is gluing, at every node. So the coarse
/// problem falls into one for each cluster, and what a cluster's own supports do not hold is a part of R, and
/// of G.

#include "epafi/decomposition/FloatingBodies.hpp"
#include "epafi/decomposition/SharedNodes.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::decomposition {

/// Two subdomains that hang together, by their numbers.
struct Link {
  int subdomain, other;
};

/// What links join among so many subdomains: the piece of each, numbered in the order of their lowest
/// members. Not collective.
std::vector<int> piecesOf(std::size_t numSubdomains, std::span<const Link> links);

/// The cluster of each subdomain of the whole problem, on every rank: runs of subdomains of a body in the
/// order of their numbers, cut where subdomains of a run do not hold each other at nodes that no other
/// cluster has.
/// \param sizes  of the runs, of each body; 0: all of it
/// Collective.
std::vector<int> findClusters(const Substructures& all, const SharedNodes& shared,
                              std::span<const int> sizes);

/// Whole bodies, with their kernels. Not collective.
std::vector<Cluster> clustersOfBodies(std::span<const Body> bodies);

struct ClusterKernels {
  std::vector<Cluster> clusters;
  std::vector<Eigen::MatrixXd> kernels; ///< R^s of each of this rank's subdomains
};

/// What the supports of each cluster leave free of the near-kernel.
/// \param motions    near-kernels of this rank's subdomains
/// \param clusterOf  see findClusters
/// Precondition: the subdomains have the kernels of their bodies. Collective.
ClusterKernels findClusterKernels(const Substructures& all, std::vector<Motions> motions,
                                  const std::vector<int>& clusterOf);

} // namespace epafi::decomposition
