#include "epafi/fetidp/operator/GeneralizedInverse.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/operator/CostModel.hpp"

#include <Tpetra_Import.hpp>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace epafi::fetidp {

namespace {

/// This rank's coarse unknowns, ascending.
std::vector<decomposition::CoarseNumber> crosspointsOf(const decomposition::DecomposedProblem& problem) {
  std::set<decomposition::CoarseNumber> crosspoints;
  for (const auto& subdomain : problem.subdomains)
    crosspoints.insert(subdomain.crosspointIndices.begin(), subdomain.crosspointIndices.end());
  return {crosspoints.begin(), crosspoints.end()};
}

} // namespace

SubdomainVectors loadsOf(const decomposition::ProblemData& data) {
  SubdomainVectors loads;
  for (const decomposition::SubdomainData& own : data.subdomains())
    loads.emplace_back(own.rightHandSide());
  return loads;
}

GeneralizedInverse::GeneralizedInverse(const decomposition::DecomposedProblem& problem,
                                       const DirectSolvers& solvers,
                                       std::shared_ptr<GeneralizedInverse> earlier)
    : solvers_(solvers), crosspointMap_(problem.crosspointMap),
      multiplierPlan_(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap))),
      crosspoints_(crosspointsOf(problem)) {
  std::vector<SubdomainGroup> earlierGroups;
  std::shared_ptr<const CoarseProblem> earlierCoarse;
  if (earlier) {
    earlierGroups = earlier.use_count() == 1 ? std::move(earlier->groups_) : earlier->groups_;
    if (earlier->crosspointMap_ == crosspointMap_)
      earlierCoarse = earlier->coarseProblem_;
    earlier.reset();
  }
  const bool isNew = makeGroups(problem, std::move(earlierGroups)) || !earlierCoarse;
  if (maxOverRanks(*problem.comm, isNew ? 1.0 : 0.0) > 0) {
    earlierCoarse.reset(); // before the new one takes memory
    coarseProblem_ = std::make_shared<const CoarseProblem>(problem, groups_, crosspoints_, solvers_);
  } else {
    coarseProblem_ = std::move(earlierCoarse);
  }
}

/// Returns whether any factor is new. Earlier groups go as soon as none needs them. Collective.
bool GeneralizedInverse::makeGroups(const decomposition::DecomposedProblem& problem,
                                    std::vector<SubdomainGroup> earlierGroups) {
  std::vector<std::shared_ptr<const SubdomainGroup>> earlier(problem.subdomains.size()); // of each subdomain
  for (SubdomainGroup& group : earlierGroups) {
    const auto shared = std::make_shared<const SubdomainGroup>(std::move(group));
    for (const std::size_t member : shared->members())
      earlier[member] = shared;
  }
  auto identical = groupIdentical(problem, solvers_.shareIdentical);
  bool isNew = false;
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

/// The coarse sums begin at 0.
void GeneralizedInverse::prepareColumns(int numColumns, Workspace& work) const {
  work.groups.resize(groups_.size());
  work.coarseForces.assign(crosspoints_.size() * numColumns, AccurateSum());
  work.coarseValues.resize(crosspoints_.size(), numColumns);
}

void GeneralizedInverse::applyDual(std::span<const double> lambda, std::span<double> result, int numColumns,
                                   Workspace& work) const {
  std::fill(result.begin(), result.end(), 0.0);
  prepareColumns(numColumns, work);
  for (std::size_t g = 0; g < groups_.size(); ++g) // (K_rr⁻¹)_ΔΔ B_Δᵀ λ and z = Σ L_cᵀ Wᵀ λ
    groups_[g].applyFlexibility(lambda, work.coarseForces, numColumns, work.groups[g]);
  coarseProblem_->solve(work.coarseForces, work.coarseValues); // x_c = S_cc⁺ z
  for (std::size_t g = 0; g < groups_.size(); ++g) // Σ B_Δ (K_rr⁻¹)_ΔΔ B_Δᵀ λ + W L_c x_c
    groups_[g].applyCoupling(work.coarseValues, result, work.groups[g]);
}

void GeneralizedInverse::apply(const SubdomainVectors& b, SubdomainVectors& u, int numColumns,
                               Workspace& work) const {
  prepareColumns(numColumns, work);
  for (std::size_t g = 0; g < groups_.size(); ++g)
    groups_[g].eliminate(b, work.coarseForces, work.groups[g]);
  coarseProblem_->solve(work.coarseForces, work.coarseValues);
  u.resize(b.size());
  for (std::size_t g = 0; g < groups_.size(); ++g)
    groups_[g].substitute(work.coarseValues, b, u, work.groups[g]);
}

void GeneralizedInverse::solveRemainders(const SubdomainVectors& b, SubdomainVectors& u, int numColumns,
                                         Workspace& work) const {
  prepareColumns(numColumns, work);
  work.coarseValues.setZero();
  for (const SubdomainGroup& group : groups_)
    group.takeCrosspoints(u, work.coarseValues);
  for (std::size_t g = 0; g < groups_.size(); ++g)
    groups_[g].substitute(work.coarseValues, b, u, work.groups[g]);
}

Eigen::MatrixXd
GeneralizedInverse::coarseColumns(std::span<const std::vector<decomposition::CoarseNumber>> unknowns) const {
  std::vector<AccurateSum> units(crosspoints_.size() * unknowns.size());
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    for (const decomposition::CoarseNumber unknown : unknowns[j])
      if (crosspointMap_->isNodeGlobalElement(unknown)) // one rank says so
        units[j * crosspoints_.size() + coarseIndexOf(unknown)] = AccurateSum(1.0);
  Eigen::MatrixXd columns(crosspoints_.size(), unknowns.size());
  coarseProblem_->solve(units, columns);
  return columns;
}

decomposition::CoarsePlace GeneralizedInverse::coarseIndexOf(decomposition::CoarseNumber unknown) const {
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
