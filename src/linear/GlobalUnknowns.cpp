#include "epafi/linear/GlobalUnknowns.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>

namespace epafi::linear {

GlobalUnknowns globalUnknowns(const decomposition::Decomposition& decomposition) {
  const decomposition::DecomposedProblem& problem = decomposition.problem;
  const auto components = static_cast<GlobalOrdinal>(problem.components);
  std::vector<GlobalOrdinal> first{0}; // of each body
  for (const decomposition::BodyLayout& body : decomposition.bodies)
    first.push_back(first.back() + components * static_cast<GlobalOrdinal>(body.mesh->numNodes()));
  GlobalUnknowns unknowns;
  unknowns.reserve(problem.subdomains.size());
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    std::vector<GlobalOrdinal>& numbers = unknowns.emplace_back();
    numbers.reserve(subdomain.unknownPosition.size());
    for (const int position : subdomain.unknownPosition)
      numbers.push_back(first[static_cast<std::size_t>(subdomain.body)] +
                        components *
                            subdomain.nodes[static_cast<std::size_t>(position / problem.components)] +
                        position % problem.components);
  }
  return unknowns;
}

RCP<const Map> ownedUnknowns(const GlobalUnknowns& unknowns, const RCP<const Comm>& comm) {
  std::vector<GlobalOrdinal> touched;
  for (const std::vector<GlobalOrdinal>& numbers : unknowns)
    touched.insert(touched.end(), numbers.begin(), numbers.end());
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  collectively(*comm, [&] {
    if (!touched.empty() && touched.front() < 0)
      throw InputError("a global number of an unknown is " + std::to_string(touched.front()) +
                       "; numbers must not be negative, and prescribed positions have none");
  });
  const RCP<const Map> overlapping = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                                 Teuchos::arrayViewFromVector(touched), 0, comm));
  return Tpetra::createOneToOne(overlapping);
}

} // namespace epafi::linear
