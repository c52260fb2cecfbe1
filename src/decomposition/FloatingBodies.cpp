#include "epafi/decomposition/FloatingBodies.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/Clusters.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <map>
#include <set>
#include <span>

namespace epafi::decomposition {
namespace {

/// A motion is free if the forces that it takes are this small beside those that its displacements alone
/// would take: far above round-off, as RigidModes::freeUpTo.
constexpr double freeUpTo = 1e-9;
/// Likewise for a first look.
constexpr double nearlyFreeUpTo = 1e-6;
/// Parts of a combination of motions, in weighted length.
constexpr double roundOff = 1e-13;
/// Motions of the near-kernel that others make up, in weighted length.
constexpr double dependent = 1e-10;

/// Columns of the groups' near-kernels. Collective.
std::vector<Eigen::Index> numbersOfModes(const std::vector<Motions>& motions, const Comm& comm,
                                         std::size_t numGroups) {
  std::vector<GlobalOrdinal> sums(2 * numGroups, 0); // of modes, and of subdomains, which agree
  for (const Motions& m : motions) {
    sums[m.group] += m.near.cols();
    ++sums[numGroups + m.group];
  }
  sumOverRanks(comm, std::span(sums));
  std::vector<Eigen::Index> numbers;
  for (std::size_t g = 0; g < numGroups; ++g)
    numbers.push_back(sums[numGroups + g] > 0 ? sums[g] / sums[numGroups + g] : 0);
  return numbers;
}

/// Σ Zᵀ D Z and Σ (KZ)ᵀ D⁻¹ (KZ) of each group, D = diag K^s.
struct Energies {
  std::vector<Eigen::MatrixXd> size, force;
};

Energies energiesOf(const std::vector<Motions>& motions, const Comm& comm, std::size_t numGroups) {
  const std::vector<Eigen::Index> numModes = numbersOfModes(motions, comm, numGroups);
  std::vector<std::size_t> first(1, 0); // of each group's two matrices, which one message sums
  for (const Eigen::Index k : numModes)
    first.push_back(first.back() + 2 * k * k);
  std::vector<double> values(first.back(), 0.0);
  const auto matrix = [&](std::size_t group, std::size_t which) {
    const Eigen::Index k = numModes[group];
    return Eigen::Map<Eigen::MatrixXd>(values.data() + first[group] + which * (k * k), k, k);
  };
  for (const Motions& m : motions) {
    const std::size_t group = m.group;
    const Eigen::VectorXd d = Eigen::VectorXd(m.stiffness->diagonal()).cwiseMax(1e-300);
    const Eigen::MatrixXd forces = *m.stiffness * m.near;
    matrix(group, 0) += m.near.transpose() * d.asDiagonal() * m.near;
    matrix(group, 1) += forces.transpose() * d.cwiseInverse().asDiagonal() * forces;
  }
  sumOverRanks(comm, std::span<double>(values));
  Energies energies;
  for (std::size_t group = 0; group < numGroups; ++group) {
    energies.size.emplace_back(matrix(group, 0));
    energies.force.emplace_back(matrix(group, 1));
  }
  return energies;
}

/// Orthonormal combinations of the motions in the scalar product `size`, those that others make up left out.
/// Motions may have very different units: each is scaled to length 1 first.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& size) {
  const Eigen::VectorXd scale =
      size.diagonal().unaryExpr([](double s) { return s > 0 ? 1 / std::sqrt(s) : 0.0; });
  const direct::SymmetricEigen eigen = direct::eigenOf(scale.asDiagonal() * size * scale.asDiagonal());
  Eigen::MatrixXd basis(size.rows(), 0);
  for (Eigen::Index i = 0; i < size.rows(); ++i)
    if (eigen.values[i] > dependent) {
      basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
      basis.rightCols(1) = scale.asDiagonal() * eigen.vectors.col(i) / std::sqrt(eigen.values[i]);
    }
  return basis;
}

/// Those whose force is at most `bound` beside them.
Eigen::MatrixXd freeCombinations(const Eigen::MatrixXd& size, const Eigen::MatrixXd& force, double bound) {
  Eigen::MatrixXd basis = size.rows() > 0 ? orthonormal(size) : size;
  if (basis.cols() == 0)
    return basis;
  const direct::SymmetricEigen eigen = direct::eigenOf(basis.transpose() * force * basis);
  Eigen::MatrixXd free = basis * eigen.vectors.leftCols(eigen.numUpTo(bound * bound));
  // A motion along x has no part along y: what is round-off beside the rest of a combination would couple
  // what nothing couples.
  const Eigen::VectorXd lengths = size.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Eigen::Index m = 0; m < free.cols(); ++m) {
    const Eigen::ArrayXd parts = (lengths.asDiagonal() * free.col(m)).array().abs();
    free.col(m) = (parts <= roundOff * parts.maxCoeff()).select(0.0, free.col(m));
  }
  return free;
}

std::vector<Eigen::MatrixXd> freeCombinations(const std::vector<Motions>& motions, const Comm& comm,
                                              std::size_t numGroups, double bound) {
  const Energies energies = energiesOf(motions, comm, numGroups);
  std::vector<Eigen::MatrixXd> combinations;
  for (std::size_t group = 0; group < numGroups; ++group)
    combinations.push_back(freeCombinations(energies.size[group], energies.force[group], bound));
  return combinations;
}

} // namespace

std::vector<Eigen::MatrixXd> findFreeMotions(const std::vector<Motions>& motions, const Comm& comm,
                                             std::size_t numGroups) {
  // Squares beside larger ones tell no more than half of the digits: what they leave is looked at alone, once
  // more.
  std::vector<Eigen::MatrixXd> combinations = freeCombinations(motions, comm, numGroups, nearlyFreeUpTo);
  std::vector<Motions> nearlyFree;
  for (const Motions& m : motions)
    nearlyFree.push_back({m.group, m.stiffness, m.near * combinations[m.group]});
  const std::vector<Eigen::MatrixXd> among = freeCombinations(nearlyFree, comm, numGroups, freeUpTo);
  for (std::size_t group = 0; group < numGroups; ++group)
    combinations[group] = (combinations[group] * among[group]).eval();
  return combinations;
}

void requireConnected(const Substructures& all, const SharedNodes& shared) {
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
  owner = gatherOnAll(*all.comm, owner); // numbers ascend with ranks
  const std::vector<int> pieces = piecesOf(owner.size(), gatherOnAll(*all.comm, links));
  std::map<int, int> bodyOf;                       // of each piece, that of its lowest subdomain
  std::vector<int> pieceOf(all.bodies.size(), -1); // the first of each body
  for (std::size_t s = 0; s < pieces.size(); ++s) {
    const int known = bodyOf.try_emplace(pieces[s], owner[s]).first->second;
    const Body &own = all.bodies[owner[s]], &other = all.bodies[known];
    if (known != owner[s])
      throw InputError("subdomains of the bodies '" + own.name + "' and '" + other.name +
                       "' share nodes; what is joined is one body.");
    int& first = pieceOf[owner[s]];
    if (first < 0)
      first = pieces[s];
    if (first != pieces[s])
      throw InputError("the body '" + own.name +
                       "' falls into parts that share no node; give each part a body of its own.");
  }
}

} // namespace epafi::decomposition
