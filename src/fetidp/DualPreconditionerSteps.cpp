// What DualPreconditioner does in an iteration.

#include "epafi/fetidp/DualPreconditioner.hpp"

#include <algorithm>

namespace epafi::fetidp {

/// u = C λ, X u, and λ − J u.
void DualPreconditioner::moveCrosspoints(const MultiVector& lambda) const {
  for (Eigen::Index j = 0; j < displacement_.cols(); ++j) {
    const auto values = lambda.getData(static_cast<std::size_t>(j));
    for (const ScaledConstraint::CrosspointEntry& entry : crosspointWeights_)
      touchedSums_[static_cast<std::size_t>(entry.touched + j * displacement_.rows())].add(
          entry.weight * values[entry.multiplier]);
  }
  sumOverRanks(*map_->getComm(), touchedSums_);
  for (std::size_t i = 0; i < touchedSums_.size(); ++i)
    displacement_.data()[i] = touchedSums_[i].value();
  if (constrained_) {
    constrained_->negativeJumps(displacement_, *smooth_);
  } else {
    nearDisplacement_.noalias() = crosspoints_.extension() * displacement_;
    subtractJumps();
  }
  for (Eigen::Index j = 0; j < displacement_.cols(); ++j) {
    const auto values = lambda.getData(static_cast<std::size_t>(j));
    const auto jumps = smooth_->getDataNonConst(static_cast<std::size_t>(j));
    for (Teuchos_Ordinal row = 0; row < jumps.size(); ++row)
      jumps[row] = values[row] + jumps[row] * inverseShares_[static_cast<std::size_t>(row)];
  }
}

/// −J u but for the shares: boundaries move by −Ψ_Δ X u, each subdomain for itself.
void DualPreconditioner::subtractJumps() const {
  const Eigen::Index numColumns = displacement_.cols();
  const std::span<double> jumps = output_.values(static_cast<std::size_t>(numColumns));
  std::fill(jumps.begin(), jumps.end(), 0.0);
  for (Block& block : blocks_) {
    if (block.near.size() == 0)
      continue;
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    for (Eigen::Index j = 0; j < numColumns; ++j)
      for (Eigen::Index member = 0; member < block.near.cols(); ++member)
        for (Eigen::Index c = 0; c < block.near.rows(); ++c)
          block.motion(c, member + j * block.near.cols()) =
              block.near(c, member) < 0 ? 0.0 : nearDisplacement_(block.near(c, member), j);
    for (Eigen::Index column = 0; column < block.motion.cols();
         ++column) // one by one: see SymmetricBlock::Use
      block.input.col(column).noalias() = group.condensed().boundaryResponse() * block.motion.col(column);
    for (Eigen::Index j = 0; j < numColumns; ++j) {
      const double* displacement = block.input.data() + j * block.input.size() / numColumns;
      double* jump = jumps.data() + j * static_cast<Eigen::Index>(jumps.size()) / numColumns;
      for (const InterfaceEntry& entry : group.boundaryEntries())
        jump[entry.multiplier] += entry.coefficient * displacement[entry.place];
    }
  }
  output_.sumToOwners(*smooth_);
}

/// Σ B_D S_Δ B_Dᵀ at the boundaries.
void DualPreconditioner::multiplyBlocks(std::span<const double> lambda, std::span<double> result) const {
  const Eigen::Index numColumns = displacement_.cols();
  const auto stride = static_cast<Eigen::Index>(lambda.size()) / numColumns;
  std::fill(result.begin(), result.end(), 0.0);
  for (Block& block : blocks_) {
    const auto entries = std::as_const(*inverse_).groups()[block.group].boundaryEntries();
    block.input.setZero();
    for (Eigen::Index j = 0; j < numColumns; ++j) {
      double* input = block.input.data() + j * block.input.size() / numColumns;
      const double* values = lambda.data() + j * stride;
      const double* weight = block.weights.data();
      for (const InterfaceEntry& entry : entries)
        input[entry.place] += *weight++ * values[entry.multiplier];
    }
    block.stiffness->apply(block.input, block.output);
    for (Eigen::Index j = 0; j < numColumns; ++j) {
      const double* output = block.output.data() + j * block.output.size() / numColumns;
      double* values = result.data() + j * stride;
      const double* weight = block.weights.data();
      for (const InterfaceEntry& entry : entries)
        values[entry.multiplier] += *weight++ * output[entry.place];
    }
  }
}

/// The result over the shares, in place of λ − J u.
void DualPreconditioner::shareResult() const {
  for (std::size_t j = 0; j < smooth_->getNumVectors(); ++j) {
    const auto result = result_->getData(j);
    const auto shared = smooth_->getDataNonConst(j);
    for (Teuchos_Ordinal row = 0; row < shared.size(); ++row)
      shared[row] = result[row] * inverseShares_[static_cast<std::size_t>(row)];
  }
}

/// What forces at the boundaries, −Jᵀ of the result, are at the near crosspoints.
void DualPreconditioner::passForcesOn() const {
  const Eigen::Index numColumns = displacement_.cols();
  const std::span<const double> forces = input_.toSubdomains(*smooth_);
  for (Block& block : blocks_) {
    if (block.near.size() == 0)
      continue;
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    block.input.setZero();
    for (Eigen::Index j = 0; j < numColumns; ++j) {
      double* force = block.input.data() + j * block.input.size() / numColumns;
      const double* values = forces.data() + j * static_cast<Eigen::Index>(forces.size()) / numColumns;
      for (const InterfaceEntry& entry : group.boundaryEntries())
        force[entry.place] += entry.coefficient * values[entry.multiplier];
    }
    for (Eigen::Index column = 0; column < block.motion.cols(); ++column)
      block.motion.col(column).noalias() =
          group.condensed().boundaryResponse().transpose() * block.input.col(column);
    for (Eigen::Index j = 0; j < numColumns; ++j)
      for (Eigen::Index member = 0; member < block.near.cols(); ++member)
        for (Eigen::Index c = 0; c < block.near.rows(); ++c)
          if (block.near(c, member) >= 0)
            nearSums_[static_cast<std::size_t>(block.near(c, member) + j * nearForces_.rows())].add(
                block.motion(c, member + j * block.near.cols()));
  }
  sumOverRanks(*map_->getComm(), nearSums_);
  for (std::size_t i = 0; i < nearSums_.size(); ++i)
    nearForces_.data()[i] = nearSums_[i].value();
}

/// Adds Cᵀ (Ŝ u − Jᵀ of the result) to the result, Jᵀ by way of the near crosspoints or at once.
void DualPreconditioner::addCrosspointForces() const {
  shareResult();
  if (constrained_) {
    std::fill(touchedSums_.begin(), touchedSums_.end(), AccurateSum());
    constrained_->subtractForces(*smooth_, touchedSums_);
    sumOverRanks(*map_->getComm(), touchedSums_);
    forces_.noalias() = constrained_->stiffness() * displacement_;
    for (std::size_t i = 0; i < touchedSums_.size(); ++i)
      forces_.data()[i] += touchedSums_[i].value();
  } else {
    passForcesOn();
    forces_.noalias() = crosspoints_.stiffness() * displacement_;
    forces_.noalias() += crosspoints_.extension().transpose() * nearForces_;
  }
  for (Eigen::Index j = 0; j < displacement_.cols(); ++j) {
    const auto values = result_->getDataNonConst(static_cast<std::size_t>(j));
    for (const ScaledConstraint::CrosspointEntry& entry : crosspointWeights_)
      values[entry.multiplier] += entry.weight * forces_(entry.touched, j);
  }
}

void DualPreconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                               double beta) const {
  const std::size_t numColumns = x.getNumVectors();
  prepareColumns(static_cast<Eigen::Index>(numColumns));
  const bool movesCrosspoints = crosspoints_.size() > 0;
  if (movesCrosspoints)
    moveCrosspoints(x);
  const auto input = input_.toSubdomains(movesCrosspoints ? *smooth_ : x);
  multiplyBlocks(input, output_.values(numColumns));
  output_.sumToOwners(*result_);
  if (movesCrosspoints)
    addCrosspointForces();
  for (std::size_t j = 0; j < numColumns && !untouched_.empty(); ++j) {
    const auto result = result_->getDataNonConst(j);
    const auto given = x.getData(j);
    for (const int row : untouched_)
      result[row] = given[row];
  }
  y.update(alpha, *result_, beta);
}

/// result += B_D t, t = S_Δ(v − u)_Δ the forces that hold the boundaries at u, where they would go to v without; and to the
/// near crosspoints what is missing there, (f − K v)_C.
void DualPreconditioner::addForcesOf(const decomposition::DecomposedProblem& problem,
                                     const SubdomainVectors& given, const SubdomainVectors& free,
                                     std::span<double> result) const {
  for (Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    const decomposition::Subdomain& like = problem.subdomains[group.members().front()];
    const std::vector<int>& boundary = group.condensed().interface().boundary;
    for (std::size_t m = 0; m < group.members().size(); ++m) {
      const std::size_t s = group.members()[m];
      for (std::size_t i = 0; i < boundary.size(); ++i) {
        const int unknown = like.remainderUnknowns[static_cast<std::size_t>(boundary[i])];
        block.input(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(m)) =
            free[s](unknown, 0) - given[s](unknown, 0);
      }
    }
    block.stiffness->apply(block.input, block.output);
    const double* weight = block.weights.data();
    for (const InterfaceEntry& entry : group.boundaryEntries())
      result[static_cast<std::size_t>(entry.multiplier)] += *weight++ * block.output.data()[entry.place];
    for (Eigen::Index m = 0; m < block.near.cols(); ++m) {
      const std::size_t s = group.members()[static_cast<std::size_t>(m)];
      const Eigen::VectorXd missing =
          problem.subdomains[s].load - *problem.subdomains[s].stiffness * free[s].col(0);
      for (Eigen::Index c = 0; c < block.near.rows(); ++c)
        if (block.near(c, m) >= 0)
          nearSums_[static_cast<std::size_t>(block.near(c, m))].add(
              missing[like.crosspointUnknowns[static_cast<std::size_t>(c)]]);
    }
  }
}

RCP<Vector> DualPreconditioner::multipliersOf(const decomposition::DecomposedProblem& problem,
                                              const SubdomainVectors& given) const {
  prepareColumns(1);
  displacement_.setZero();
  SubdomainVectors loads, free = given;
  for (const auto& subdomain : problem.subdomains)
    loads.emplace_back(subdomain.load);
  inverse_->solveRemainders(loads, free); // v
  const std::span<double> result = output_.values(1);
  std::fill(result.begin(), result.end(), 0.0);
  addForcesOf(problem, given, free, result);
  output_.sumToOwners(*result_);
  if (crosspoints_.size() > 0)
    addCrosspointForces();
  RCP<Vector> multipliers = rcp(new Vector(*result_->getVector(0), Teuchos::Copy));
  return multipliers;
}

} // namespace epafi::fetidp
