#include "epafi/accuracy/Transfer.hpp"

#include "epafi/accuracy/PointLocation.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <numeric>
#include <optional>

namespace epafi::accuracy {
namespace {

using decomposition::Subdomain;
using model::Decomposition;

/// Where a node of the fine mesh lies in the coarse one.
struct Guess {
  std::size_t subdomain, node; ///< among this rank's subdomains, and their nodes
  std::array<GlobalOrdinal, mesh::mostNodes>
      sources{}; ///< nodes of the coarse element, by numbers of the whole problem
  std::array<double, mesh::mostNodes> weights{};
  std::size_t numSources = 0;
};

/// Places of the nodes with crosspoint values or entries of B, ascending.
std::vector<std::size_t> interfaceNodes(const Subdomain& subdomain, int components) {
  std::vector<char> isWanted(subdomain.nodes.size(), 0);
  const auto want = [&](int unknown) {
    const int position = subdomain.unknownPosition[unknown];
    isWanted[position / components] = 1;
  };
  for (const int unknown : subdomain.crosspointUnknowns)
    want(unknown);
  for (const auto& entry : subdomain.constraint)
    want(entry.unknown);
  for (const auto& average : subdomain.averages) {
    want(average.carrier);
    for (const int other : average.others)
      want(other);
  }
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < isWanted.size(); ++i)
    if (isWanted[i] != 0)
      nodes.push_back(i);
  return nodes;
}

std::vector<std::size_t> allNodes(const Subdomain& subdomain) {
  std::vector<std::size_t> nodes(subdomain.nodes.size());
  std::iota(nodes.begin(), nodes.end(), std::size_t{0});
  return nodes;
}

std::vector<Guess> locate(const Decomposition& from, const Decomposition& to, NodesOf nodes) {
  const std::vector<GlobalOrdinal> first = model::firstNodes(from.bodies);
  std::vector<std::optional<PointLocation>> locations(from.bodies.size());
  std::vector<Guess> guesses;
  for (std::size_t s = 0; s < to.problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = to.problem.subdomains[s];
    const std::size_t body = subdomain.body;
    const mesh::Mesh &coarse = *from.bodies[body].mesh, &fine = *to.bodies[body].mesh;
    if (nodes == NodesOf::subdomains && coarse.part() != nullptr)
      throw Error("The values of a mesh are asked for at nodes anywhere, but no rank holds it whole.");
    if (!locations[body])
      locations[body].emplace(coarse);
    for (const std::size_t node : nodes == NodesOf::interfaces
                                      ? interfaceNodes(subdomain, to.problem.components)
                                      : allNodes(subdomain)) {
      const Location location = locations[body]->find(fine.point(subdomain.nodes[node]));
      const mesh::ElementNodes sources(coarse, location.element);
      Guess guess{s, node, {}, location.weights, sources.size()};
      std::copy(sources.begin(), sources.end(), guess.sources.begin());
      for (std::size_t i = 0; i < guess.numSources; ++i)
        guess.sources[i] += first[body];
      guesses.push_back(guess);
    }
  }
  return guesses;
}

/// The coarse values that the guesses need. Collective.
RCP<MultiVector> gatherSources(const Decomposition& from, std::span<const Eigen::VectorXd> displacement,
                               std::span<const Guess> guesses) {
  const auto& problem = from.problem;
  const std::vector<GlobalOrdinal> first = model::firstNodes(from.bodies);
  std::vector<GlobalOrdinal> here, wanted;
  for (const Subdomain& subdomain : problem.subdomains)
    for (const GlobalOrdinal node : subdomain.nodes)
      here.push_back(first[subdomain.body] + node);
  for (const Guess& guess : guesses)
    wanted.insert(wanted.end(), guess.sources.begin(), guess.sources.begin() + guess.numSources);
  const RCP<const Map> local = makeMap(std::move(here), problem.comm);
  const std::size_t components = problem.components;
  MultiVector mine(local, components);
  for (std::size_t c = 0; c < components; ++c) {
    const auto values = mine.getDataNonConst(c);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
      const Subdomain& subdomain = problem.subdomains[s];
      for (std::size_t i = 0; i < subdomain.nodes.size(); ++i)
        values[local->getLocalElement(first[subdomain.body] + subdomain.nodes[i])] =
            displacement[s][i * components + c];
    }
  }
  const RCP<const Map> owned = Tpetra::createOneToOne(local),
                       target = makeMap(std::move(wanted), problem.comm);
  MultiVector unique(owned, components);
  unique.doImport(mine, Import(local, owned), Tpetra::INSERT);
  const RCP<MultiVector> result = rcp(new MultiVector(target, components));
  result->doImport(unique, Import(owned, target), Tpetra::INSERT);
  return result;
}

} // namespace

std::vector<Eigen::VectorXd> interpolate(const Decomposition& from,
                                         std::span<const Eigen::VectorXd> displacement,
                                         const Decomposition& to, NodesOf nodes) {
  std::vector<Guess> guesses;
  collectively(*to.problem.comm, [&] { guesses = locate(from, to, nodes); });
  const RCP<const MultiVector> sources = gatherSources(from, displacement, guesses);
  const Map& map = *sources->getMap();
  const std::size_t components = to.problem.components;
  std::vector<Eigen::VectorXd> result;
  for (const Subdomain& subdomain : to.problem.subdomains)
    result.emplace_back(Eigen::VectorXd::Zero(subdomain.nodes.size() * components));
  for (std::size_t c = 0; c < components; ++c) {
    const auto values = sources->getData(c);
    for (const Guess& guess : guesses) {
      double& value = result[guess.subdomain][guess.node * components + c];
      for (std::size_t i = 0; i < guess.numSources; ++i)
        value += guess.weights[i] * values[map.getLocalElement(guess.sources[i])];
    }
  }
  return result;
}

} // namespace epafi::accuracy
