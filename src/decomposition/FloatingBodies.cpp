#include "epafi/decomposition/FloatingBodies.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <numeric>
#include <set>
#include <span>

namespace epafi::decomposition {
namespace {

/// A motion is free if the forces that it takes are this small beside those that its displacements alone would take: far
/// above round-off, as fem::RigidModes::freeUpTo.
constexpr double freeUpTo = 1e-9;
/// Likewise for a first look.
constexpr double nearlyFreeUpTo = 1e-6;
/// Motions of the near-kernel that others make up, in weighted length.
constexpr double dependent = 1e-10;

/// Σ Zᵀ D Z and Σ (KZ)ᵀ D⁻¹ (KZ) of each body, D = diag K^s.
struct Energies {
  std::vector<Eigen::MatrixXd> size, force;
};

Energies energiesOf(const std::vector<Motions>& motions, const Comm& comm, std::size_t numBodies) {
  std::vector<GlobalOrdinal> numModes(numBodies, 0);
  for (const Motions& m : motions)
    numModes[static_cast<std::size_t>(m.body)] = m.near.cols();
  Energies energies;
  for (std::size_t b = 0; b < numBodies; ++b) {
    const Eigen::Index k = maxOverRanks(comm, numModes[b]);
    energies.size.emplace_back(Eigen::MatrixXd::Zero(k, k));
    energies.force.emplace_back(Eigen::MatrixXd::Zero(k, k));
  }
  for (const Motions& m : motions) {
    const auto b = static_cast<std::size_t>(m.body);
    const Eigen::VectorXd d = Eigen::VectorXd(m.stiffness->diagonal()).cwiseMax(1e-300);
    const Eigen::MatrixXd forces = *m.stiffness * m.near;
    energies.size[b] += m.near.transpose() * d.asDiagonal() * m.near;
    energies.force[b] += forces.transpose() * d.cwiseInverse().asDiagonal() * forces;
  }
  for (auto* matrices : {&energies.size, &energies.force})
    for (Eigen::MatrixXd& matrix : *matrices)
      sumOverRanks(comm, std::span<double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
  return energies;
}

/// Orthonormal combinations of the motions in the scalar product `size`, those that others make up left out. Motions may
/// have very different units: each is scaled to length 1 first.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& size) {
  const Eigen::VectorXd scale =
      size.diagonal().unaryExpr([](double s) { return s > 0 ? 1 / std::sqrt(s) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * size * scale.asDiagonal());
  Eigen::MatrixXd basis(size.rows(), 0);
  for (Eigen::Index i = 0; i < size.rows(); ++i)
    if (eigen.eigenvalues()[i] > dependent) {
      basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
      basis.rightCols(1) =
          scale.asDiagonal() * eigen.eigenvectors().col(i) / std::sqrt(eigen.eigenvalues()[i]);
    }
  return basis;
}

/// Those whose force is at most `bound` beside them.
Eigen::MatrixXd freeCombinations(const Eigen::MatrixXd& size, const Eigen::MatrixXd& force, double bound) {
  Eigen::MatrixXd basis = size.rows() > 0 ? orthonormal(size) : size;
  if (basis.cols() == 0)
    return basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(basis.transpose() * force * basis);
  const auto numFree = (eigen.eigenvalues().array() <= bound * bound).count(); // ascending
  return basis * eigen.eigenvectors().leftCols(numFree);
}

std::vector<Eigen::MatrixXd> freeCombinations(const std::vector<Motions>& motions, const Comm& comm,
                                              std::size_t numBodies, double bound) {
  const Energies energies = energiesOf(motions, comm, numBodies);
  std::vector<Eigen::MatrixXd> combinations;
  for (std::size_t b = 0; b < numBodies; ++b)
    combinations.push_back(freeCombinations(energies.size[b], energies.force[b], bound));
  return combinations;
}

} // namespace

std::vector<Eigen::MatrixXd> findFreeMotions(const std::vector<Motions>& motions, const Comm& comm,
                                             std::vector<Body>& bodies) {
  // Squares beside larger ones tell no more than half of the digits: what they leave is looked at alone, once more.
  std::vector<Eigen::MatrixXd> combinations = freeCombinations(motions, comm, bodies.size(), nearlyFreeUpTo);
  std::vector<Motions> nearlyFree;
  for (const Motions& m : motions)
    nearlyFree.push_back({m.body, m.stiffness, m.near * combinations[static_cast<std::size_t>(m.body)]});
  const std::vector<Eigen::MatrixXd> among = freeCombinations(nearlyFree, comm, bodies.size(), freeUpTo);
  int offset = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    combinations[b] = (combinations[b] * among[b]).eval();
    bodies[b].kernelDimension = static_cast<int>(combinations[b].cols());
    bodies[b].kernelOffset = offset;
    offset += bodies[b].kernelDimension;
  }
  return combinations;
}

void requireConnected(const Substructures& all, const SharedNodes& shared) {
  struct Link {
    int subdomain, neighbour;
  };
  std::vector<Link> links;
  std::vector<int> owner; // body of each subdomain
  for (std::size_t s = 0; s < all.size(); ++s) {
    owner.push_back(all.subdomains[s].body);
    std::set<int> neighbours;
    for (const SharedNodes::Copy& copy : shared.copiesOf(s))
      neighbours.insert(shared.subdomainsAt(copy.node).begin(), shared.subdomainsAt(copy.node).end());
    for (const int neighbour : neighbours)
      links.push_back({all.subdomains[s].number, neighbour});
  }
  links = gatherOnAll(*all.comm, links);
  owner = gatherOnAll(*all.comm, owner); // numbers ascend with ranks
  std::vector<std::size_t> root(owner.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&root](std::size_t s) {
    while (root[s] != s)
      s = root[s] = root[root[s]];
    return s;
  };
  for (const Link& link : links)
    root[find(static_cast<std::size_t>(link.subdomain))] = find(static_cast<std::size_t>(link.neighbour));
  const std::span<const Body> bodies = all.bodies;
  std::vector<std::size_t> first(bodies.size(), root.size());
  for (std::size_t s = 0; s < root.size(); ++s) {
    const auto b = static_cast<std::size_t>(owner[s]);
    if (owner[find(s)] != owner[s])
      throw InputError("subdomains of the bodies '" + bodies[b].name + "' and '" +
                       bodies[static_cast<std::size_t>(owner[find(s)])].name +
                       "' share nodes; what is joined is one body.");
    if (first[b] == root.size())
      first[b] = find(s);
    if (first[b] != find(s))
      throw InputError("the body '" + bodies[b].name +
                       "' falls into parts that share no node; give each part a body of its own.");
  }
}

} // namespace epafi::decomposition
