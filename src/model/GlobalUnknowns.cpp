#include "epafi/model/GlobalUnknowns.hpp"

namespace epafi::model {

std::vector<std::vector<GlobalOrdinal>> globalUnknowns(const Decomposition& decomposition) {
  const decomposition::DecomposedProblem& problem = decomposition.problem;
  const GlobalOrdinal components = problem.components;
  const std::vector<GlobalOrdinal> firstNode = firstNodes(decomposition.bodies);
  std::vector<std::vector<GlobalOrdinal>> unknowns;
  unknowns.reserve(problem.subdomains.size());
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    std::vector<GlobalOrdinal>& numbers = unknowns.emplace_back();
    numbers.reserve(subdomain.nodes.size() * components);
    for (const GlobalOrdinal node : subdomain.nodes)
      for (GlobalOrdinal component = 0; component < components; ++component)
        numbers.push_back((firstNode[subdomain.body] + node) * components + component);
  }
  return unknowns;
}

} // namespace epafi::model
