#include "epafi/fetidp/operator/RowProducts.hpp"

#include "epafi/base/Maps.hpp"
#include "epafi/base/SortUnique.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::fetidp {
namespace {

/// From crosspointMap to the coarse unknowns of this rank's subdomains. Collective.
RCP<const Import> planOf(const decomposition::DecomposedProblem& problem) {
  std::vector<GlobalOrdinal> here;
  for (const auto& subdomain : problem.subdomains)
    here.insert(here.end(), subdomain.crosspointIndices.begin(), subdomain.crosspointIndices.end());
  sortUnique(here);
  return rcp(new Import(problem.crosspointMap, mapInOrder(here, problem.comm)));
}

} // namespace

RowProducts::RowProducts(const decomposition::DecomposedProblem& problem)
    : problem_(problem), crosspointPlan_(planOf(problem)),
      exchange_(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap))),
      mine_(crosspointPlan_->getTargetMap()), owned_(problem.crosspointMap) {
  for (const auto& subdomain : problem.subdomains)
    forces_.emplace_back(Eigen::VectorXd::Zero(subdomain.stiffness->rows()));
}

const std::vector<Eigen::VectorXd>& RowProducts::forces(const Vector& lambda, bool isMagnitude) const {
  const std::span<const double> values = exchange_.toSubdomains(lambda);
  mine_.putScalar(0.0);
  const Map& coarse = *mine_.getMap();
  for (std::size_t s = 0; s < forces_.size(); ++s) {
    const auto& subdomain = problem_.subdomains[s];
    forces_[s].setZero();
    for (const auto& entry : subdomain.constraint) {
      const double part = entry.coefficient * values[entry.multiplier];
      forces_[s][entry.unknown] += isMagnitude ? std::abs(part) : part;
    }
    const auto sums = mine_.getDataNonConst();
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      sums[coarse.getLocalElement(subdomain.crosspointIndices[i])] +=
          forces_[s][subdomain.crosspointUnknowns[i]];
  }
  owned_.putScalar(0.0);
  owned_.doExport(mine_, *crosspointPlan_, Tpetra::ADD);
  mine_.doImport(owned_, *crosspointPlan_, Tpetra::INSERT);
  const auto sums = mine_.getData();
  for (std::size_t s = 0; s < forces_.size(); ++s) {
    const auto& subdomain = problem_.subdomains[s];
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      forces_[s][subdomain.crosspointUnknowns[i]] =
          sums[coarse.getLocalElement(subdomain.crosspointIndices[i])];
  }
  return forces_;
}

void RowProducts::gram(const Vector& lambda, Vector& y) const {
  const std::vector<Eigen::VectorXd>& u = forces(lambda);
  const std::span<double> rows = exchange_.zeros();
  for (std::size_t s = 0; s < u.size(); ++s)
    for (const auto& entry : problem_.subdomains[s].constraint)
      rows[entry.multiplier] += entry.coefficient * u[s][entry.unknown];
  exchange_.sumToOwners(y);
}

RCP<Vector> RowProducts::norms() const {
  const std::span<double> rows = exchange_.zeros();
  for (const auto& subdomain : problem_.subdomains)
    for (const auto& entry : subdomain.constraint)
      rows[entry.multiplier] += entry.coefficient * entry.coefficient;
  RCP<Vector> norms = rcp(new Vector(problem_.multiplierMap));
  exchange_.sumToOwners(*norms);
  const auto values = norms->getDataNonConst();
  for (double& value : values)
    value = std::sqrt(value);
  return norms;
}

} // namespace epafi::fetidp
