#include "epafi/output/NodalStress.hpp"

#include "epafi/accuracy/RecoveredFlux.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/output/Slab.hpp"

#include <Tpetra_Export.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <utility>

namespace epafi::output {
namespace {

using decomposition::Subdomain;

constexpr std::size_t numStresses = 6;

/// Nodes of this rank's subdomains of a body, each once. Collective.
RCP<const Map> nodesOfBody(const decomposition::DecomposedProblem& problem, int body) {
  std::vector<GlobalOrdinal> nodes;
  for (const Subdomain& subdomain : problem.subdomains)
    if (subdomain.body == body)
      nodes.insert(nodes.end(), subdomain.nodes.begin(), subdomain.nodes.end());
  return makeMap(std::move(nodes), problem.comm);
}

/// Adds up over all materials around a node.
void addSubdomain(const accuracy::SubdomainFlux& flux, const Subdomain& subdomain, MultiVector& sums) {
  for (std::size_t k = 0; k <= numStresses; ++k) {
    const auto column = sums.getDataNonConst(k);
    for (Eigen::Index slot = 0; slot < flux.values.cols(); ++slot) {
      const GlobalOrdinal node = subdomain.nodes[flux.nodeOf(static_cast<std::size_t>(slot))];
      column[sums.getMap()->getLocalElement(node)] += flux.values(static_cast<Eigen::Index>(k), slot);
    }
  }
}

} // namespace

std::vector<double> vonMisesAtNodes(const SolvedScene& solved, int body) {
  const auto place = static_cast<std::size_t>(body);
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  const model::BodyLayout& layout = solved.decomposition.bodies[place];
  MultiVector sums(nodesOfBody(problem, body), numStresses + 1);
  collectively(*problem.comm, [&] {
    accuracy::BodyElements elements(solved.scene.bodies[place], layout);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
      if (problem.subdomains[s].body == body)
        addSubdomain(sumFlux(elements, problem.subdomains[s], solved.solution.displacement[s]),
                     problem.subdomains[s], sums);
  });
  MultiVector slab(slabMap(layout.mesh->numNodes(), problem.comm), numStresses + 1);
  slab.doExport(sums, Export(sums.getMap(), slab.getMap()), Tpetra::ADD);

  std::vector<Teuchos::ArrayRCP<const double>> columns;
  for (std::size_t k = 0; k <= numStresses; ++k)
    columns.push_back(slab.getData(k));
  std::vector<double> result;
  result.reserve(slab.getLocalLength());
  for (Teuchos::Ordinal row = 0; row < columns[0].size(); ++row) {
    fem::SymmetricTensor stress{};
    for (std::size_t k = 0; k < stress.size(); ++k)
      stress[k] = columns[k][row] / columns[numStresses][row];
    result.push_back(fem::vonMisesOf(stress));
  }
  return result;
}

} // namespace epafi::output
