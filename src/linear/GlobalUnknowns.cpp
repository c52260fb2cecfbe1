#include "epafi/linear/GlobalUnknowns.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"

#include <Tpetra_Map.hpp>

#include <string>
#include <utility>

namespace epafi::linear {

namespace {

std::vector<GlobalOrdinal> atUnknowns(const decomposition::Subdomain& subdomain, Eigen::Index numPositions,
                                      const std::vector<GlobalOrdinal>& atPositions) {
  const std::string name = "subdomain " + std::to_string(subdomain.number);
  if (std::ssize(atPositions) != numPositions)
    throw InputError(name + " has " + std::to_string(numPositions) +
                     " positions (nodes times components), but " + std::to_string(atPositions.size()) +
                     " global numbers; give one for each position, at prescribed ones any");
  std::vector<GlobalOrdinal> numbers;
  numbers.reserve(subdomain.unknownPosition.size());
  for (const int position : subdomain.unknownPosition) {
    numbers.push_back(atPositions[position]);
    if (numbers.back() < 0)
      throw InputError(name + " has an unknown at position " + std::to_string(position) +
                       " whose global number is " + std::to_string(numbers.back()) +
                       "; numbers of unknowns must not be negative");
  }
  return numbers;
}

} // namespace

GlobalUnknowns atUnknowns(const decomposition::DecomposedProblem& problem,
                          const GlobalUnknowns& atPositions) {
  GlobalUnknowns unknowns;
  collectively(*problem.comm, [&] {
    if (atPositions.size() != problem.subdomains.size())
      throw InputError("there are lists of global unknowns for " + std::to_string(atPositions.size()) +
                       " subdomains, but the problem has " + std::to_string(problem.subdomains.size()) +
                       " on this rank; give one list for each");
    for (std::size_t s = 0; s < atPositions.size(); ++s)
      unknowns.push_back(
          atUnknowns(problem.subdomains[s], problem.numPositions(problem.subdomains[s]), atPositions[s]));
  });
  return unknowns;
}

RCP<const Map> touchedUnknowns(const GlobalUnknowns& unknowns, const RCP<const Comm>& comm) {
  std::vector<GlobalOrdinal> touched;
  for (const std::vector<GlobalOrdinal>& numbers : unknowns)
    touched.insert(touched.end(), numbers.begin(), numbers.end());
  return makeMap(std::move(touched), comm);
}

RCP<const Map> ownedUnknowns(const GlobalUnknowns& unknowns, const RCP<const Comm>& comm) {
  return Tpetra::createOneToOne(touchedUnknowns(unknowns, comm));
}

} // namespace epafi::linear
