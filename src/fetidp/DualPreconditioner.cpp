#include "epafi/fetidp/DualPreconditioner.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <utility>

namespace epafi::fetidp {
namespace {

/// K_ΔΔ.
Eigen::MatrixXd boundaryBlock(const decomposition::Subdomain& subdomain,
                              const CondensedSubdomain& condensed) {
  const Eigen::Index size = condensed.numBoundary();
  const std::vector<int>& positionOf = condensed.interface().positionOf;
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index column = 0; column < subdomain.stiffness->cols(); ++column) {
    const int j = positionOf[static_cast<std::size_t>(column)];
    if (j < 0 || j >= size)
      continue;
    for (decomposition::SparseMatrix::InnerIterator entry(*subdomain.stiffness, column); entry; ++entry)
      if (const int i = positionOf[static_cast<std::size_t>(entry.row())]; i >= 0 && i < size)
        block(i, j) = entry.value();
  }
  return block;
}

} // namespace

DualPreconditioner::DualPreconditioner(const decomposition::DecomposedProblem& problem,
                                       std::shared_ptr<GeneralizedInverse> inverse,
                                       const PreconditionerParameters& parameters)
    : map_(problem.multiplierMap), inverse_(std::move(inverse)), crosspoints_(problem, *inverse_),
      input_(inverse_->multiplierPlan()), output_(inverse_->multiplierPlan()),
      smooth_(rcp(new MultiVector(map_, 1))), result_(rcp(new MultiVector(map_, 1))) {
  collectively(*problem.comm, [&] { makeBlocks(problem, parameters.type, parameters.isSingle); });
  ScaledConstraint scaled =
      scaleConstraint(problem, crosspoints_, parameters.scaling, inverse_->multiplierPlan());
  for (Block& block : blocks_)
    for (const std::size_t member : std::as_const(*inverse_).groups()[block.group].members())
      block.weights.insert(block.weights.end(), scaled.boundary[member].begin(),
                           scaled.boundary[member].end());
  untouched_ = std::move(scaled.untouched);
  if (crosspoints_.size() > 0)
    prepareCrosspoints(scaled);
}

void DualPreconditioner::makeBlocks(const decomposition::DecomposedProblem& problem,
                                    PreconditionerParameters::Type type, bool isSingle) {
  using Precision = direct::SymmetricBlock::Precision;
  const auto groups = std::as_const(*inverse_).groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const CondensedSubdomain& condensed = groups[g].condensed();
    const Eigen::MatrixXd matrix =
        type == PreconditionerParameters::Type::lumped
            ? boundaryBlock(problem.subdomains[groups[g].members().front()], condensed)
            : condensed.factor().schurComplement();
    const auto precision = isSingle ? Precision::single : Precision::full;
    blocks_.push_back({g, direct::SymmetricBlock(matrix, groups[g].use(), precision), {}, {}, {}, {}, {}});
  }
}

/// C and the shares go to the owners of their rows; groups learn which of their crosspoints may move. Collective.
void DualPreconditioner::prepareCrosspoints(const ScaledConstraint& scaled) {
  std::copy(scaled.boundaryShares.begin(), scaled.boundaryShares.end(), output_.values().begin());
  output_.sumToOwners(*result_);
  for (const double share : result_->getData(0))
    inverseShares_.push_back(share > 0 ? 1 / share : 0.0);

  const Map& ghosts = *inverse_->multiplierPlan()->getTargetMap();
  std::vector<double> mine; // row, touched, weight
  for (const ScaledConstraint::CrosspointEntry& entry : scaled.atCrosspoints)
    mine.insert(mine.end(), {static_cast<double>(ghosts.getGlobalElement(entry.multiplier)),
                             static_cast<double>(entry.touched), entry.weight});
  const std::vector<double> all = gatherOnAll(*map_->getComm(), mine);
  for (std::size_t k = 0; k < all.size(); k += 3)
    if (const LocalOrdinal row = map_->getLocalElement(static_cast<GlobalOrdinal>(all[k])); row >= 0)
      crosspointWeights_.push_back({row, static_cast<int>(all[k + 1]), all[k + 2]});
  std::sort(crosspointWeights_.begin(), crosspointWeights_.end(),
            [](const ScaledConstraint::CrosspointEntry& a, const ScaledConstraint::CrosspointEntry& b) {
              return std::pair(a.multiplier, a.touched) < std::pair(b.multiplier, b.touched);
            });

  for (Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    const auto first = group.crosspointIndices(0);
    if (first.empty() || crosspoints_.nearIndexOf(first.front()) < 0)
      continue; // contact touches no crosspoint of this body
    block.near.resize(group.condensed().numCrosspoints(), static_cast<Eigen::Index>(group.members().size()));
    for (Eigen::Index member = 0; member < block.near.cols(); ++member) {
      const auto crosspoints = group.crosspointIndices(static_cast<std::size_t>(member));
      for (Eigen::Index c = 0; c < block.near.rows(); ++c)
        block.near(c, member) = crosspoints_.nearIndexOf(crosspoints[static_cast<std::size_t>(c)]);
    }
  }
}

/// Work space for k columns; sums begin at 0.
void DualPreconditioner::prepareColumns(Eigen::Index numColumns) const {
  if (result_->getNumVectors() != static_cast<std::size_t>(numColumns)) {
    result_ = rcp(new MultiVector(map_, static_cast<std::size_t>(numColumns)));
    smooth_ = rcp(new MultiVector(map_, static_cast<std::size_t>(numColumns)));
  }
  for (Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    block.input.resize(group.condensed().numBoundary(),
                       static_cast<Eigen::Index>(group.members().size()) * numColumns);
    block.output.resizeLike(block.input);
    block.motion.resize(block.near.rows(), block.near.cols() * numColumns);
  }
  displacement_.resize(crosspoints_.size(), numColumns);
  forces_.resizeLike(displacement_);
  nearDisplacement_.resize(crosspoints_.extension().rows(), numColumns);
  nearForces_.resizeLike(nearDisplacement_);
  touchedSums_.assign(static_cast<std::size_t>(displacement_.size()), AccurateSum());
  nearSums_.assign(static_cast<std::size_t>(nearForces_.size()), AccurateSum());
}

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
  nearDisplacement_.noalias() = crosspoints_.extension() * displacement_;
  subtractJumps();
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
          block.motion(c, member + j * block.near.cols()) = nearDisplacement_(block.near(c, member), j);
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
    block.stiffness.apply(block.input, block.output);
    for (Eigen::Index j = 0; j < numColumns; ++j) {
      const double* output = block.output.data() + j * block.output.size() / numColumns;
      double* values = result.data() + j * stride;
      const double* weight = block.weights.data();
      for (const InterfaceEntry& entry : entries)
        values[entry.multiplier] += *weight++ * output[entry.place];
    }
  }
}

/// What forces at the boundaries, −Jᵀ of the result, are at the near crosspoints.
void DualPreconditioner::passForcesOn() const {
  const Eigen::Index numColumns = displacement_.cols();
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    const auto result = result_->getData(static_cast<std::size_t>(j));
    const auto shared = smooth_->getDataNonConst(static_cast<std::size_t>(j));
    for (Teuchos_Ordinal row = 0; row < shared.size(); ++row)
      shared[row] = result[row] * inverseShares_[static_cast<std::size_t>(row)];
  }
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
          nearSums_[static_cast<std::size_t>(block.near(c, member) + j * nearForces_.rows())].add(
              block.motion(c, member + j * block.near.cols()));
  }
  sumOverRanks(*map_->getComm(), nearSums_);
  for (std::size_t i = 0; i < nearSums_.size(); ++i)
    nearForces_.data()[i] = nearSums_[i].value();
}

/// Adds Cᵀ (Ŝ u + Xᵀ of the forces at the near crosspoints) to the result.
void DualPreconditioner::addCrosspointForces() const {
  passForcesOn();
  forces_.noalias() = crosspoints_.stiffness() * displacement_;
  forces_.noalias() += crosspoints_.extension().transpose() * nearForces_;
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

std::size_t DualPreconditioner::bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_)
    bytes += block.stiffness.bytes();
  return bytes;
}

} // namespace epafi::fetidp
