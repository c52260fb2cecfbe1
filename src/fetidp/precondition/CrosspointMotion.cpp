#include "epafi/fetidp/precondition/CrosspointMotion.hpp"

#include "epafi/base/Maps.hpp"
#include "epafi/base/Records.hpp"

#include <algorithm>
#include <utility>

namespace epafi::fetidp {

CrosspointMotion::CrosspointMotion(const decomposition::DecomposedProblem& problem,
                                   std::shared_ptr<const GeneralizedInverse> inverse,
                                   ContactCrosspoints crosspoints, const ScaledConstraint& scaled,
                                   const RCP<const qp::DeflatedOperator>& deflated)
    : inverse_(std::move(inverse)), crosspoints_(std::move(crosspoints)),
      isLocal_(crosspoints_.comm()->getSize() < problem.comm->getSize()),
      work_{MultiplierExchange(inverse_->multiplierPlan()),
            MultiplierExchange(inverse_->multiplierPlan()),
            {},
            {},
            {},
            {},
            {},
            {},
            rcp(new MultiVector(problem.multiplierMap, 1))} {
  takeShares(scaled);
  takeWeights(scaled, *problem.multiplierMap);
  findFollowers();
  if (!deflated.is_null())
    constrain(problem, *deflated);
}

/// They go to the owners of their rows. Collective.
void CrosspointMotion::takeShares(const ScaledConstraint& scaled) {
  MultiVector shares(inverse_->multiplierPlan()->getSourceMap(), 1);
  std::copy(scaled.boundaryShares.begin(), scaled.boundaryShares.end(), work_.output.values().begin());
  work_.output.sumToOwners(shares);
  for (const double share : shares.getData(0))
    inverseShares_.push_back(share > 0 ? 1 / share : 0.0);
}

/// C goes to the owners of its rows where they know all crosspoints. Collective.
void CrosspointMotion::takeWeights(const ScaledConstraint& scaled, const Map& map) {
  if (isLocal_) {
    weights_ = scaled.atCrosspoints;
    return;
  }
  const Map& ghosts = *inverse_->multiplierPlan()->getTargetMap();
  struct Weight {
    GlobalOrdinal row;
    int touched;
    double value;
  };
  std::vector<Weight> mine;
  std::vector<GlobalOrdinal> rows;
  for (const ScaledConstraint::CrosspointEntry& entry : scaled.atCrosspoints) {
    rows.push_back(ghosts.getGlobalElement(entry.multiplier));
    mine.push_back({rows.back(), entry.touched, entry.weight});
  }
  for (const Weight& weight : sendRecords<Weight>(map.getComm(), mine, ownersOf(map, rows)))
    weights_.push_back({map.getLocalElement(weight.row), weight.touched, weight.value});
  std::sort(weights_.begin(), weights_.end(),
            [](const ScaledConstraint::CrosspointEntry& a, const ScaledConstraint::CrosspointEntry& b) {
              return std::pair(a.multiplier, a.touched) < std::pair(b.multiplier, b.touched);
            });
}

/// The groups of bodies that contact touches at a crosspoint.
void CrosspointMotion::findFollowers() {
  for (const SubdomainGroup& group : inverse_->groups()) {
    Eigen::MatrixXi near(group.condensed().numCrosspoints(), group.members().size());
    for (Eigen::Index member = 0; member < near.cols(); ++member) {
      const auto crosspoints = group.crosspointIndices(member);
      for (Eigen::Index c = 0; c < near.rows(); ++c)
        near(c, member) = crosspoints_.nearIndexOf(crosspoints[c]);
    }
    if ((near.array() >= 0).any())
      followers_.push_back({&group, std::move(near)});
  }
  work_.followers.resize(followers_.size());
}

/// Lets the boundaries that follow one crosspoint value after the other come apart, and constrains that.
/// Collective.
void CrosspointMotion::constrain(const decomposition::DecomposedProblem& problem,
                                 const qp::DeflatedOperator& deflated) {
  const std::size_t size = crosspoints_.size();
  MultiVector jumps(problem.multiplierMap, size), atCrosspoints(problem.multiplierMap, size);
  prepareColumns(crosspoints_.size());
  work_.nearDisplacement = crosspoints_.extension();
  negativeJumps(jumps);
  jumps.scale(-1.0); // J
  const std::span<double> entries = work_.output.zeros(size);
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      if (const int touched = crosspoints_.indexOf(subdomain, entry.unknown); touched >= 0)
        entries[entry.multiplier + touched * entries.size() / size] += entry.coefficient;
  work_.output.sumToOwners(atCrosspoints); // B_C
  constrained_.emplace(deflated.space(), jumps, atCrosspoints, crosspoints_.stiffness());
}

/// Work space for k columns; sums begin at 0.
void CrosspointMotion::prepareColumns(std::size_t numColumns) const {
  for (std::size_t f = 0; f < followers_.size(); ++f) {
    const Eigen::MatrixXi& near = followers_[f].near;
    work_.followers[f].atCrosspoints.resize(near.rows(), near.cols() * numColumns);
    work_.followers[f].atBoundary.resize(followers_[f].group->condensed().numBoundary(),
                                         near.cols() * numColumns);
  }
  work_.nearDisplacement.resize(crosspoints_.numNear(), numColumns);
  work_.nearForces.resizeLike(work_.nearDisplacement);
  work_.forces.resize(crosspoints_.size(), numColumns);
  work_.touchedSums.assign(work_.forces.size(), AccurateSum());
  work_.nearSums.assign(work_.nearForces.size(), AccurateSum());
  if (work_.shared->getNumVectors() != numColumns)
    work_.shared = rcp(new MultiVector(work_.shared->getMap(), numColumns));
}

void CrosspointMotion::split(const MultiVector& lambda, Eigen::MatrixXd& u, MultiVector& rest) const {
  prepareColumns(lambda.getNumVectors());
  u.resize(crosspoints_.size(), work_.forces.cols());
  const std::span<const double> atSubdomains =
      isLocal_ ? work_.input.toSubdomains(lambda) : std::span<const double>();
  for (Eigen::Index j = 0; j < u.cols(); ++j) {
    const std::size_t column = j;
    const std::size_t length = atSubdomains.size() / lambda.getNumVectors();
    const auto owned = lambda.getData(column);
    const double* values = isLocal_ ? atSubdomains.data() + column * length : owned.get();
    for (const ScaledConstraint::CrosspointEntry& entry : weights_)
      work_.touchedSums[entry.touched + j * u.rows()].add(entry.weight * values[entry.multiplier]);
  }
  sumOverRanks(*crosspoints_.comm(), work_.touchedSums, u.data());
  if (constrained_) {
    constrained_->negativeJumps(u, rest);
  } else {
    crosspoints_.extend(u, work_.nearDisplacement);
    negativeJumps(rest);
  }
  for (std::size_t j = 0; j < rest.getNumVectors(); ++j) {
    const auto values = lambda.getData(j);
    const auto jumps = rest.getDataNonConst(j);
    for (Teuchos_Ordinal row = 0; row < jumps.size(); ++row)
      jumps[row] = values[row] + jumps[row] * inverseShares_[row];
  }
}

/// −J of the near displacement, but for the shares: boundaries move by −Ψ_Δ X u, each subdomain for itself.
void CrosspointMotion::negativeJumps(MultiVector& jumps) const {
  const Eigen::Index numColumns = work_.nearDisplacement.cols();
  const std::span<double> result = work_.output.zeros(numColumns);
  for (std::size_t f = 0; f < followers_.size(); ++f) {
    const auto& [group, near] = followers_[f];
    auto& [motion, displacement] = work_.followers[f];
    for (Eigen::Index j = 0; j < numColumns; ++j)
      for (Eigen::Index member = 0; member < near.cols(); ++member)
        for (Eigen::Index c = 0; c < near.rows(); ++c)
          motion(c, member + j * near.cols()) =
              near(c, member) < 0 ? 0.0 : work_.nearDisplacement(near(c, member), j);
    for (Eigen::Index column = 0; column < motion.cols(); ++column) // one by one: see SymmetricBlock::Use
      displacement.col(column).noalias() = group->condensed().boundaryResponse() * motion.col(column);
    addProduct(group->boundaryEntries(), displacement, numColumns, result);
  }
  work_.output.sumToOwners(jumps);
}

/// What forces at the boundaries, −Jᵀ of the shared ones, are at the near crosspoints.
void CrosspointMotion::addForcesOfJumps() const {
  const Eigen::Index numColumns = work_.nearForces.cols();
  const std::span<const double> given = work_.input.toSubdomains(*work_.shared);
  for (std::size_t f = 0; f < followers_.size(); ++f) {
    const auto& [group, near] = followers_[f];
    auto& [passedOn, forces] = work_.followers[f];
    forces.setZero();
    addTransposed(group->boundaryEntries(), given, numColumns, forces);
    for (Eigen::Index column = 0; column < passedOn.cols(); ++column)
      passedOn.col(column).noalias() = group->condensed().boundaryResponse().transpose() * forces.col(column);
    for (Eigen::Index j = 0; j < numColumns; ++j)
      for (Eigen::Index member = 0; member < near.cols(); ++member)
        for (Eigen::Index c = 0; c < near.rows(); ++c)
          if (near(c, member) >= 0)
            work_.nearSums[near(c, member) + j * work_.nearForces.rows()].add(
                passedOn(c, member + j * near.cols()));
  }
}

void CrosspointMotion::addForces(const Eigen::MatrixXd& u, MultiVector& y) const {
  prepareColumns(u.cols());
  pullBack(u, y);
}

void CrosspointMotion::addForcesAtRest(const decomposition::DecomposedProblem& problem,
                                       const SubdomainVectors& f, const SubdomainVectors& v,
                                       MultiVector& y) const {
  prepareColumns(1);
  for (const auto& [group, near] : followers_)
    for (Eigen::Index m = 0; m < near.cols(); ++m) {
      const std::size_t s = group->members()[m];
      const decomposition::Subdomain& subdomain = problem.subdomains[s];
      const Eigen::VectorXd missing = f[s].col(0) - *subdomain.stiffness * v[s].col(0);
      for (Eigen::Index c = 0; c < near.rows(); ++c)
        if (near(c, m) >= 0)
          work_.nearSums[near(c, m)].add(missing[subdomain.crosspointUnknowns[c]]);
    }
  pullBack(Eigen::MatrixXd::Zero(crosspoints_.size(), 1), y);
}

/// Adds Cᵀ (Ŝ u − Jᵀy) and what the near sums begin with to y, Jᵀ by way of the near crosspoints or at once.
void CrosspointMotion::pullBack(const Eigen::MatrixXd& u, MultiVector& y) const {
  for (std::size_t j = 0; j < y.getNumVectors(); ++j) {
    const auto forces = y.getData(j);
    const auto shared = work_.shared->getDataNonConst(j);
    for (Teuchos_Ordinal row = 0; row < shared.size(); ++row)
      shared[row] = forces[row] * inverseShares_[row];
  }
  if (constrained_) {
    constrained_->subtractForces(*work_.shared, work_.touchedSums);
    sumOverRanks(*crosspoints_.comm(), work_.touchedSums);
    work_.forces.noalias() = constrained_->stiffness() * u;
    for (std::size_t i = 0; i < work_.touchedSums.size(); ++i)
      work_.forces.data()[i] += work_.touchedSums[i].value();
  } else {
    addForcesOfJumps();
    sumOverRanks(*crosspoints_.comm(), work_.nearSums, work_.nearForces.data());
    crosspoints_.forcesOf(u, work_.nearForces, work_.forces);
  }
  const auto addTo = [&](Eigen::Index column, double* values) {
    for (const ScaledConstraint::CrosspointEntry& entry : weights_)
      values[entry.multiplier] += entry.weight * work_.forces(entry.touched, column);
  };
  if (isLocal_) {
    const std::size_t numColumns = u.cols();
    const std::span<double> values = work_.output.zeros(numColumns);
    for (Eigen::Index j = 0; j < u.cols(); ++j)
      addTo(j, values.data() + j * (values.size() / numColumns));
    work_.output.sumToOwners(*work_.shared);
    y.update(1.0, *work_.shared, 1.0);
    return;
  }
  for (Eigen::Index j = 0; j < u.cols(); ++j)
    addTo(j, y.getDataNonConst(j).get());
}

} // namespace epafi::fetidp
