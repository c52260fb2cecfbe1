#include "epafi/linear/PartiallyAssembledInverse.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Maps.hpp"

#include <utility>

namespace epafi::linear {
namespace {

using decomposition::DecomposedProblem;

GlobalOrdinal numRemainders(const DecomposedProblem& problem) {
  return problem.remainderMap->getGlobalNumElements();
}

/// Remainders, then crosspoint values.
RCP<const Map> mergedMap(const DecomposedProblem& problem) {
  const auto remainders = localIndices(*problem.remainderMap),
             crosspoints = localIndices(*problem.crosspointMap);
  std::vector<GlobalOrdinal> numbers(remainders.begin(), remainders.end());
  for (const GlobalOrdinal crosspoint : crosspoints)
    numbers.push_back(numRemainders(problem) + crosspoint);
  return mapInOrder(numbers, problem.comm);
}

GlobalUnknowns mergedUnknowns(const DecomposedProblem& problem) {
  GlobalUnknowns unknowns;
  LocalOrdinal next = 0; // remainders lie in the order of the subdomains
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    std::vector<GlobalOrdinal>& numbers = unknowns.emplace_back(subdomain.unknownPosition.size());
    for (const int unknown : subdomain.remainderUnknowns)
      numbers[unknown] = problem.remainderMap->getGlobalElement(next++);
    for (std::size_t c = 0; c < subdomain.crosspointUnknowns.size(); ++c)
      numbers[subdomain.crosspointUnknowns[c]] = numRemainders(problem) + subdomain.crosspointIndices[c];
  }
  return unknowns;
}

} // namespace

PartiallyAssembledInverse::PartiallyAssembledInverse(
    const DecomposedProblem& problem, std::shared_ptr<const fetidp::GeneralizedInverse> inverse)
    : SymmetricOperator(mergedMap(problem)), inverse_(std::move(inverse)),
      exchange_(getDomainMap(), mergedUnknowns(problem)),
      shares_(problem, exchange_, fetidp::PreconditionerParameters::Scaling::multiplicity) {}

void PartiallyAssembledInverse::multiply(const MultiVector& x, MultiVector& y) const {
  exchange_.toSubdomains(x, forces_);
  shares_.scale(forces_);
  inverse_->apply(forces_, values_, static_cast<int>(x.getNumVectors()), work_);
  shares_.scale(values_);
  exchange_.sum(values_, y);
}

} // namespace epafi::linear
