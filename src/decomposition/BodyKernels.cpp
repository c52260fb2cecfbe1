#include "epafi/decomposition/BodyKernels.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/RigidModes.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <string>

namespace epafi::decomposition {
namespace {

/// Whether unknowns are displacements, of which rigid motions cost nothing; else constants do.
bool movesRigidly(const Substructures& all) {
  return all.components == all.places.dimension;
}

/// Of each body, about its middle and scaled by half of its largest extent; of unknowns that are no
/// displacements none is asked for. Collective.
std::vector<RigidModes> rigidModesOf(const Substructures& all) {
  if (!movesRigidly(all))
    return std::vector<RigidModes>(all.bodies.size(), {1, {}, 1.0});
  std::vector<RigidModes> modes;
  for (std::size_t b = 0; b < all.bodies.size(); ++b) {
    Point centre{};
    double size = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (std::size_t s = 0; s < all.size(); ++s)
        for (std::size_t node = 0; index(all.subdomains[s].body) == b && node < all.numNodes(s); ++node) {
          low = std::min(low, all.point(s, node)[d]);
          high = std::max(high, all.point(s, node)[d]);
        }
      low = minOverRanks(*all.comm, low);
      high = maxOverRanks(*all.comm, high);
      if (low > high)
        continue; // a body without subdomains
      centre[d] = 0.5 * (low + high);
      size = std::max(size, 0.5 * (high - low));
    }
    modes.emplace_back(all.components, centre, size > 0 ? size : 1.0, all.bodies[b].isOfRevolution);
  }
  return modes;
}

/// Rigid motions of this rank's subdomains, or constants. \param modes  of each body
std::vector<Motions> motionsOf(const Substructures& all, const std::vector<RigidModes>& modes) {
  const bool isElastic = movesRigidly(all);
  std::vector<Motions> motions;
  for (std::size_t s = 0; s < all.size(); ++s) {
    const Subdomain& subdomain = all.subdomains[s];
    const RigidModes& own = modes[subdomain.body];
    std::map<std::size_t, const Eigen::Matrix3d*> axes;
    for (const NodeFrame& frame : subdomain.frames)
      axes.emplace(frame.node, &frame.axes);
    Motions& target = motions.emplace_back(Motions{subdomain.body, all.nodal[s].stiffness.get(), {}});
    target.near.resize(subdomain.unknownPosition.size(), isElastic ? own.number() : all.components);
    for (std::size_t i = 0; i < subdomain.unknownPosition.size(); ++i) {
      const int position = subdomain.unknownPosition[i];
      const std::size_t node = position / all.components;
      const int component = position % all.components;
      const auto found = axes.find(node);
      const Eigen::Index row = i;
      if (!isElastic)
        target.near.row(row) = Eigen::RowVectorXd::Unit(target.near.cols(), component);
      else if (found != axes.end())
        target.near.row(row) = own.along(all.point(s, node), found->second->col(component)).transpose();
      else
        target.near.row(row) = own.at(all.point(s, node), component).transpose();
    }
  }
  return motions;
}

/// Z^s as the application gives it.
Eigen::MatrixXd givenNearKernel(const SubdomainMatrix& matrix, const OwnSubdomain& own,
                                Eigen::Index numFree) {
  Eigen::MatrixXd near = Eigen::MatrixXd::Zero(numFree, matrix.nearKernel.cols());
  for (std::size_t i = 0; i < own.row.size(); ++i)
    if (own.row[i] >= 0)
      near.row(own.row[i]) = matrix.nearKernel.row(i);
  return near;
}

/// \throws InputError, the same on all ranks. Collective.
void requireEqualNumbers(const std::vector<Motions>& motions, const Substructures& all) {
  std::vector<GlobalOrdinal> numModes(all.bodies.size(), -1);
  for (const Motions& m : motions) {
    GlobalOrdinal& number = numModes[m.group];
    number = std::max<GlobalOrdinal>(number, m.near.cols());
  }
  for (GlobalOrdinal& number : numModes)
    number = maxOverRanks(*all.comm, number);
  collectively(*all.comm, [&] {
    for (std::size_t s = 0; s < motions.size(); ++s)
      if (const GlobalOrdinal number = numModes[motions[s].group]; motions[s].near.cols() != number)
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
                         return index(m.body) == b && m.nearKernel.cols() > 0;
                       })));
  return result;
}

} // namespace

std::vector<Motions> rigidMotionsOf(const Substructures& all) {
  return motionsOf(all, rigidModesOf(all));
}

BodyKernels findKernels(const Substructures& all, const std::vector<SubdomainMatrix>& matrices,
                        const std::vector<OwnSubdomain>& own) {
  BodyKernels result{{all.bodies.begin(), all.bodies.end()}, {}, {}};
  const std::size_t numBodies = result.bodies.size();
  const bool isElastic = movesRigidly(all);
  const std::vector<RigidModes> rigid = rigidModesOf(all);
  std::vector<Motions> motions = motionsOf(all, rigid);
  for (std::size_t s = 0; s < matrices.size(); ++s)
    if (matrices[s].nearKernel.cols() > 0)
      motions[s].near = givenNearKernel(matrices[s], own[s], motions[s].near.rows());
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
      const Point& centre = rigid[b].centre();
      body.motions = {
          {centre[0], centre[1], centre[2]}, rigid[b].size(), rigid[b].twists() * combinations[b]};
    }
  }
  for (const Motions& m : motions)
    result.kernels.emplace_back(m.near * combinations[m.group]);
  result.near = std::move(motions);
  return result;
}

} // namespace epafi::decomposition
