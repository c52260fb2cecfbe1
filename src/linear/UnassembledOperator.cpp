#include "epafi/linear/UnassembledOperator.hpp"

#include "epafi/linear/LinearProblemChecks.hpp"
#include "epafi/linear/NodalBasis.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::linear {
namespace {

/// Local indices of the rows that no unknown has. Collective.
std::vector<LocalOrdinal> rowsWithoutUnknown(const decomposition::DecomposedProblem& problem,
                                             const UnknownExchange& exchange) {
  SubdomainVectors ones;
  for (const decomposition::Subdomain& subdomain : problem.subdomains)
    ones.emplace_back(Eigen::MatrixXd::Ones(subdomain.stiffness->rows(), 1));
  MultiVector copies(exchange.map(), 1);
  exchange.sum(ones, copies);
  std::vector<LocalOrdinal> rows;
  const auto numbers = copies.getData(0);
  for (LocalOrdinal i = 0; i < numbers.size(); ++i)
    if (numbers[i] == 0)
      rows.push_back(i);
  return rows;
}

} // namespace

UnassembledOperator::UnassembledOperator(
    const std::shared_ptr<const decomposition::DecomposedProblem>& problem, GlobalUnknowns unknowns,
    const RCP<const Map>& map, Checked /*checked*/)
    : SymmetricOperator(map.is_null() ? ownedUnknowns(unknowns, problem->comm) : map), problem_(problem),
      unknowns_(std::move(unknowns)), exchange_(getDomainMap(), unknowns_),
      identityRows_(rowsWithoutUnknown(*problem_, exchange_)) {
  requireJoinedCopies(*problem_, unknowns_, identityRows_.size(), exchange_);
}

void UnassembledOperator::copyIdentity(const MultiVector& x, MultiVector& y) const {
  if (identityRows_.empty())
    return;
  for (std::size_t j = 0; j < x.getNumVectors(); ++j) {
    const auto given = x.getData(j);
    const auto copied = y.getDataNonConst(j);
    for (const LocalOrdinal row : identityRows_)
      copied[row] = given[row];
  }
}

void UnassembledOperator::multiply(const MultiVector& x, MultiVector& y) const {
  exchange_.toSubdomains(x, values_);
  forces_.resize(values_.size());
  for (std::size_t s = 0; s < values_.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem_->subdomains[s];
    toUnknowns(subdomain, values_[s]);
    forces_[s].noalias() = *subdomain.stiffness * values_[s];
    toForcesOfValues(subdomain, forces_[s]);
  }
  exchange_.sum(forces_, y);
  copyIdentity(x, y);
}

RCP<Vector> UnassembledOperator::load(const decomposition::ProblemData& data) const {
  SubdomainVectors loads = fetidp::loadsOf(data);
  for (std::size_t s = 0; s < loads.size(); ++s)
    toForcesOfValues(problem_->subdomains[s], loads[s]);
  RCP<Vector> b = rcp(new Vector(exchange_.map()));
  exchange_.sum(loads, *b);
  return b;
}

} // namespace epafi::linear
