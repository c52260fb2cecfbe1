#include "epafi/linear/UnassembledOperator.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/linear/JoinedCopies.hpp"
#include "epafi/linear/NodalBasis.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <string>
#include <utility>

namespace epafi::linear {
namespace {

/// The lists as they are. \throws InputError if there is not one number for each unknown. Collective.
const GlobalUnknowns& checked(const decomposition::DecomposedProblem& problem,
                              const GlobalUnknowns& unknowns) {
  collectively(*problem.comm, [&] {
    if (unknowns.size() != problem.subdomains.size())
      throw InputError("there are lists of global unknowns for " + std::to_string(unknowns.size()) +
                       " subdomains, but the problem has " + std::to_string(problem.subdomains.size()) +
                       " on this rank; give one list for each");
    for (std::size_t s = 0; s < unknowns.size(); ++s)
      if (unknowns[s].size() != problem.subdomains[s].unknownPosition.size())
        throw InputError("subdomain " + std::to_string(problem.subdomains[s].number) + " has " +
                         std::to_string(problem.subdomains[s].unknownPosition.size()) + " unknowns, but " +
                         std::to_string(unknowns[s].size()) +
                         " global numbers; give one for each unknown and none for prescribed positions");
  });
  return unknowns;
}

} // namespace

UnassembledOperator::UnassembledOperator(std::shared_ptr<const decomposition::DecomposedProblem> problem,
                                         const GlobalUnknowns& unknowns, const RCP<const Map>& map)
    : problem_(std::move(problem)), unknowns_(checked(*problem_, unknowns)),
      exchange_(map.is_null() ? ownedUnknowns(unknowns_, problem_->comm) : map, unknowns_),
      result_(rcp(new MultiVector(exchange_.map(), 1))) {
  requireJoinedCopies(*problem_, unknowns_, exchange_);
}

void UnassembledOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                                double beta) const {
  if (result_->getNumVectors() != x.getNumVectors())
    result_ = rcp(new MultiVector(exchange_.map(), x.getNumVectors()));
  exchange_.toSubdomains(x, values_);
  forces_.resize(values_.size());
  for (std::size_t s = 0; s < values_.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem_->subdomains[s];
    toUnknowns(subdomain, values_[s]);
    forces_[s].noalias() = *subdomain.stiffness * values_[s];
    toForcesOfValues(subdomain, forces_[s]);
  }
  exchange_.sum(forces_, *result_);
  y.update(alpha, *result_, beta); // beta = 0 overwrites, NaN included
}

RCP<Vector> UnassembledOperator::load() const {
  SubdomainVectors loads;
  for (const decomposition::Subdomain& subdomain : problem_->subdomains) {
    loads.emplace_back(subdomain.load);
    toForcesOfValues(subdomain, loads.back());
  }
  RCP<Vector> b = rcp(new Vector(exchange_.map()));
  exchange_.sum(loads, *b);
  return b;
}

} // namespace epafi::linear
