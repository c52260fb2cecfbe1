#include "epafi/decomposition/BodyKernels.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/FloatingBodies.hpp"
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
void requireEqualNumbers(const std::vector<Motions>& motions, const std::vector<Piece>& pieces,
                         const DecomposedProblem& problem) {
  std::vector<double> numModes(problem.bodies.size(), -1);
  for (const Motions& m : motions) {
    double& number = numModes[static_cast<std::size_t>(m.body)];
    number = std::max(number, static_cast<double>(m.near.cols()));
  }
  for (double& number : numModes)
    number = maxOverRanks(*problem.comm, number);
  collectively(*problem.comm, [&] {
    for (std::size_t s = 0; s < motions.size(); ++s)
      if (const double number = numModes[static_cast<std::size_t>(motions[s].body)];
          static_cast<double>(motions[s].near.cols()) != number)
        throw InputError("subdomain " + std::to_string(pieces[s].number) + " has a near-kernel of " +
                         std::to_string(motions[s].near.cols()) + " columns, another one of its body has " +
                         std::to_string(static_cast<int>(number)) + ".");
    for (std::size_t b = 0; b < numModes.size(); ++b)
      if (numModes[b] < 0)
        throw InputError("the body '" + problem.bodies[b].name + "' has no subdomain.");
  });
}

/// Which of the bodies move by rigid motions, as far as anyone has given a near-kernel. Collective.
std::vector<bool> areRigid(const std::vector<SubdomainMatrix>& matrices, std::size_t numBodies,
                           const Comm& comm) {
  std::vector<double> given(numBodies, 0);
  for (const SubdomainMatrix& matrix : matrices)
    if (matrix.nearKernel.cols() > 0)
      given[static_cast<std::size_t>(matrix.body)] = 1;
  std::vector<bool> result;
  for (const double isGiven : given)
    result.push_back(maxOverRanks(comm, isGiven) == 0);
  return result;
}

} // namespace

void findKernels(const std::vector<SubdomainMatrix>& matrices, const std::vector<OwnSubdomain>& own,
                 int dimension, std::vector<Piece>& pieces, DecomposedProblem& problem) {
  const bool isElastic = problem.components == dimension;
  const std::size_t numBodies = problem.bodies.size();
  const auto rigid = rigidModesOf(matrices, isElastic ? problem.components : 1, numBodies, *problem.comm);
  std::vector<Motions> motions;
  for (std::size_t s = 0; s < matrices.size(); ++s)
    motions.push_back(nearMotions(matrices[s], own[s], *pieces[s].stiffness,
                                  rigid[static_cast<std::size_t>(matrices[s].body)], problem.components,
                                  isElastic));
  requireEqualNumbers(motions, pieces, problem);
  const std::vector<Eigen::MatrixXd> combinations = findFreeMotions(motions, *problem.comm, problem.bodies);
  const std::vector<bool> isRigid = areRigid(matrices, numBodies, *problem.comm);
  problem.kernelDimension = 0;
  for (std::size_t b = 0; b < numBodies; ++b) {
    Body& body = problem.bodies[b];
    problem.kernelDimension += body.kernelDimension;
    if (body.kernelDimension > 0 && isElastic && isRigid[b]) {
      const fem::Point& centre = rigid[b].centre();
      body.motions = {
          {centre[0], centre[1], centre[2]}, rigid[b].size(), rigid[b].twists() * combinations[b]};
    }
  }
  for (std::size_t s = 0; s < motions.size(); ++s)
    pieces[s].assembled.kernel = motions[s].near * combinations[static_cast<std::size_t>(motions[s].body)];
}

} // namespace epafi::decomposition
