#include "epafi/decomposition/BodyKernels.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fem/RigidModes.hpp"

#include <algorithm>
#include <string>

namespace epafi::decomposition {
namespace {

/// Of each body, about its middle and scaled by half of its largest extent. Collective.
std::vector<fem::RigidModes> rigidModesOf(const std::vector<SubdomainMatrix>& matrices, int components,
                                          std::size_t numBodies, const Comm& comm) {
  std::vector<fem::RigidModes> modes;
  for (std::size_t b = 0; b < numBodies; ++b) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const SubdomainMatrix& matrix : matrices)
      if (static_cast<std::size_t>(matrix.body) == b)
        for (Eigen::Index c = 0; c < matrix.coordinates.cols(); ++c) {
          low[c] = std::min(low[c], matrix.coordinates.col(c).minCoeff());
          high[c] = std::max(high[c], matrix.coordinates.col(c).maxCoeff());
        }
    fem::Point centre{};
    double size = 0;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double from = minOverRanks(comm, low[c]), to = maxOverRanks(comm, high[c]);
      if (from > to)
        continue; // a coordinate that the space does not have, or a body without subdomains
      centre[static_cast<std::size_t>(c)] = 0.5 * (from + to);
      size = std::max(size, 0.5 * (to - from));
    }
    modes.emplace_back(components, centre, size > 0 ? size : 1.0);
  }
  return modes;
}

/// Z^s: the given near-kernel, rigid motions, or constants.
Motions nearMotions(const SubdomainMatrix& matrix, const OwnSubdomain& own, const SparseMatrix& stiffness,
                    const fem::RigidModes& rigid, int components, bool isElastic) {
  const Eigen::Index given = matrix.nearKernel.cols(),
                     number = given > 0 ? given : (isElastic ? rigid.number() : components);
  Motions motions{matrix.body, &stiffness, Eigen::MatrixXd::Zero(stiffness.rows(), number)};
  for (std::size_t i = 0; i < own.row.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const int row = own.row[i], component = static_cast<int>(own.unknowns[i] % components);
    if (row < 0)
      continue;
    if (given > 0)
      motions.near.row(row) = matrix.nearKernel.row(place);
    else if (isElastic)
      motions.near.row(row) = rigid.at(pointAt(matrix.coordinates, place), component).transpose();
    else
      motions.near(row, component) = 1;
  }
  return motions;
}

/// \throws InputError, the same on all ranks. Collective.
void requireEqualNumbers(const std::vector<Motions>& motions, const Substructures& all) {
  std::vector<GlobalOrdinal> numModes(all.bodies.size(), -1);
  for (const Motions& m : motions) {
    GlobalOrdinal& number = numModes[static_cast<std::size_t>(m.group)];
    number = std::max(number, static_cast<GlobalOrdinal>(m.near.cols()));
  }
  for (GlobalOrdinal& number : numModes)
    number = maxOverRanks(*all.comm, number);
  collectively(*all.comm, [&] {
    for (std::size_t s = 0; s < motions.size(); ++s)
      if (const GlobalOrdinal number = numModes[static_cast<std::size_t>(motions[s].group)];
          motions[s].near.cols() != number)
        throw InputError("subdomain " + std::to_string(all.subdomains[s].number) + " has a near-kernel of " +
                         std::to_string(motions[s].near.cols()) + " columns, another one of its body has " +
                         std::to_string(number) + ".");
    for (std::size_t b = 0; b < numModes.size(); ++b)
      if (numModes[b] < 0)
        throw InputError("the body '" + all.bodies[b].name + "' has no subdomain.");
  });
}

/// Which of the bodies move by rigid motions, as far as anyone has given a near-kernel. Collective.
std::vector<bool> areRigid(const std::vector<SubdomainMatrix>& matrices, std::size_t numBodies,
                           const Comm& comm) {
  std::vector<bool> result;
  for (std::size_t b = 0; b < numBodies; ++b)
    result.push_back(
        !holdsAnywhere(comm, std::any_of(matrices.begin(), matrices.end(), [b](const SubdomainMatrix& m) {
                         return static_cast<std::size_t>(m.body) == b && m.nearKernel.cols() > 0;
                       })));
  return result;
}

} // namespace

BodyKernels findKernels(const Substructures& all, const std::vector<SubdomainMatrix>& matrices,
                        const std::vector<OwnSubdomain>& own) {
  const auto components = static_cast<int>(all.components);
  const bool isElastic = components == all.places.dimension;
  BodyKernels result{{all.bodies.begin(), all.bodies.end()}, {}, {}};
  const std::size_t numBodies = result.bodies.size();
  const auto rigid = rigidModesOf(matrices, isElastic ? components : 1, numBodies, *all.comm);
  std::vector<Motions> motions;
  for (std::size_t s = 0; s < matrices.size(); ++s)
    motions.push_back(nearMotions(matrices[s], own[s], *all.nodal[s].stiffness,
                                  rigid[static_cast<std::size_t>(matrices[s].body)], components, isElastic));
  requireEqualNumbers(motions, all);
  const std::vector<Eigen::MatrixXd> combinations = findFreeMotions(motions, *all.comm, numBodies);
  const std::vector<bool> isRigid = areRigid(matrices, numBodies, *all.comm);
  int offset = 0;
  for (std::size_t b = 0; b < numBodies; ++b) {
    Body& body = result.bodies[b];
    body.kernelDimension = static_cast<int>(combinations[b].cols());
    body.kernelOffset = offset;
    offset += body.kernelDimension;
    if (body.kernelDimension > 0 && isElastic && isRigid[b]) {
      const fem::Point& centre = rigid[b].centre();
      body.motions = {
          {centre[0], centre[1], centre[2]}, rigid[b].size(), rigid[b].twists() * combinations[b]};
    }
  }
  for (const Motions& m : motions)
    result.kernels.emplace_back(m.near * combinations[static_cast<std::size_t>(m.group)]);
  result.near = std::move(motions);
  return result;
}

} // namespace epafi::decomposition
