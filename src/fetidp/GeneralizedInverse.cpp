#include "epafi/fetidp/GeneralizedInverse.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/CostModel.hpp"

#include <Tpetra_Import.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace epafi::fetidp {

namespace {

/// This rank's coarse unknowns, ascending.
std::vector<GlobalOrdinal> crosspointsOf(const decomposition::DecomposedProblem& problem) {
  std::vector<GlobalOrdinal> crosspoints;
  for (const auto& subdomain : problem.subdomains)
    crosspoints.insert(crosspoints.end(), subdomain.crosspointIndices.begin(),
                       subdomain.crosspointIndices.end());
  std::sort(crosspoints.begin(), crosspoints.end());
  crosspoints.erase(std::unique(crosspoints.begin(), crosspoints.end()), crosspoints.end());
  return crosspoints;
}

} // namespace

GeneralizedInverse::GeneralizedInverse(const decomposition::DecomposedProblem& problem,
                                       const DirectSolvers& solvers)
    : solvers_(solvers) {
  update(problem);
}

void GeneralizedInverse::update(const decomposition::DecomposedProblem& problem) {
  multiplierPlan_ = rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap));
  crosspoints_ = crosspointsOf(problem);
  const bool isNew = makeGroups(problem) || crosspointMap_ != problem.crosspointMap;
  crosspointMap_ = problem.crosspointMap;
  if (maxOverRanks(*problem.comm, isNew ? 1.0 : 0.0) > 0) {
    coarseProblem_.reset();
    coarseProblem_ = std::make_unique<CoarseProblem>(problem, groups_, crosspoints_, solvers_);
  }
}

/// Returns whether any factor is new. Earlier groups go as soon as none needs them. Collective.
bool GeneralizedInverse::makeGroups(const decomposition::DecomposedProblem& problem) {
  std::vector<std::shared_ptr<const SubdomainGroup>> earlier(problem.subdomains.size()); // of each subdomain
  for (SubdomainGroup& group : groups_) {
    const auto shared = std::make_shared<const SubdomainGroup>(std::move(group));
    for (const std::size_t member : shared->members())
      earlier[member] = shared;
  }
  groups_.clear();
  auto identical = groupIdentical(problem, solvers_.shareIdentical);
  bool isNew = !coarseProblem_;
  collectively(*problem.comm, [&] {
    direct::Factorizer factorizer(solvers_.subdomains);
    groups_.reserve(identical.size());
    for (IdenticalSubdomains& group : identical) {
      const std::shared_ptr<const SubdomainGroup> previous = earlier[group.members.front()];
      for (const std::size_t member : group.members)
        earlier[member].reset();
      groups_.emplace_back(problem.subdomains, std::move(group), crosspoints_, factorizer, previous.get());
      isNew = isNew || !previous || !groups_.back().sharesFactorWith(*previous);
    }
  });
  return isNew;
}

void GeneralizedInverse::prepareDual(const DualOperatorParameters& parameters) {
  using Mode = DualOperatorParameters::Mode;
  for (SubdomainGroup& group : groups_)
    if (parameters.mode == Mode::explicitBlocks ||
        (parameters.mode == Mode::automatic && explicitPays(group, parameters.expectedProducts)))
      group.makeExplicit();
}

/// Work space for k columns; the sums begin at 0.
void GeneralizedInverse::prepareCoarse(int numColumns) {
  coarseSums_.assign(crosspoints_.size() * static_cast<std::size_t>(numColumns), AccurateSum());
  coarse_.resize(static_cast<Eigen::Index>(crosspoints_.size()), numColumns);
}

void GeneralizedInverse::applyDual(std::span<const double> lambda, std::span<double> result, int numColumns) {
  std::fill(result.begin(), result.end(), 0.0);
  prepareCoarse(numColumns);
  for (SubdomainGroup& group : groups_)
    group.applyFlexibility(lambda, coarseSums_,
                           numColumns); // B_Δ (K_rr⁻¹)_ΔΔ B_Δᵀ λ, kept, and z = Σ L_cᵀ Wᵀ λ
  coarseProblem_->solve(coarseSums_, coarse_); // x_c = S_cc⁺ z
  for (SubdomainGroup& group : groups_)
    group.applyCoupling(coarse_, result); // Σ B_Δ (K_rr⁻¹)_ΔΔ B_Δᵀ λ + W L_c x_c
}

void GeneralizedInverse::apply(const SubdomainVectors& b, SubdomainVectors& u, int numColumns) {
  prepareCoarse(numColumns);
  for (SubdomainGroup& group : groups_)
    group.eliminate(b, coarseSums_);
  coarseProblem_->solve(coarseSums_, coarse_);
  u.resize(b.size());
  for (SubdomainGroup& group : groups_)
    group.substitute(coarse_, b, u);
}

void GeneralizedInverse::solveRemainders(const SubdomainVectors& b, SubdomainVectors& u, int numColumns) {
  prepareCoarse(numColumns);
  coarse_.setZero();
  for (const SubdomainGroup& group : groups_)
    group.takeCrosspoints(u, coarse_);
  for (SubdomainGroup& group : groups_)
    group.substitute(coarse_, b, u);
}

const Eigen::MatrixXd& GeneralizedInverse::coarseColumns(std::span<const GlobalOrdinal> unknowns,
                                                         const std::vector<bool>& isOwner) {
  prepareCoarse(static_cast<int>(unknowns.size()));
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    if (isOwner[j])
      coarseSums_[j * crosspoints_.size() + static_cast<std::size_t>(coarseIndexOf(unknowns[j]))] =
          AccurateSum(1.0);
  coarseProblem_->solve(coarseSums_, coarse_);
  return coarse_;
}

int GeneralizedInverse::coarseIndexOf(GlobalOrdinal unknown) const {
  const auto found = std::lower_bound(crosspoints_.begin(), crosspoints_.end(), unknown);
  return found != crosspoints_.end() && *found == unknown ? static_cast<int>(found - crosspoints_.begin())
                                                          : -1;
}

void GeneralizedInverse::subtractForces(std::span<const double> lambda, SubdomainVectors& b) const {
  for (const SubdomainGroup& group : groups_)
    group.subtractForces(lambda, b);
}

void GeneralizedInverse::constraint(const SubdomainVectors& u, std::span<double> result) const {
  std::fill(result.begin(), result.end(), 0.0);
  for (const SubdomainGroup& group : groups_)
    group.addConstraint(u, result);
}

std::size_t GeneralizedInverse::factorBytes() const {
  std::size_t bytes = coarseProblem_->factorBytes();
  for (const SubdomainGroup& group : groups_)
    bytes += group.factorBytes();
  return bytes;
}

} // namespace epafi::fetidp
