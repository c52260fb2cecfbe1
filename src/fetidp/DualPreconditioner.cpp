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
                                       const PreconditionerParameters& parameters,
                                       const RCP<const DeflatedDualOperator>& deflated)
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
  if (crosspoints_.size() > 0 && !deflated.is_null())
    constrainCrosspoints(problem, *deflated);
}

void DualPreconditioner::makeBlocks(const decomposition::DecomposedProblem& problem,
                                    PreconditionerParameters::Type type, bool isSingle) {
  using Precision = direct::SymmetricBlock::Precision;
  const auto groups = std::as_const(*inverse_).groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto precision = isSingle ? Precision::single : Precision::full;
    const auto stiffness =
        type == PreconditionerParameters::Type::dirichlet
            ? groups[g].boundaryStiffness(precision)
            : std::make_shared<const direct::SymmetricBlock>(
                  boundaryBlock(problem.subdomains[groups[g].members().front()], groups[g].condensed()),
                  groups[g].use(), precision);
    blocks_.push_back({g, stiffness, {}, {}, {}, {}, {}});
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
    block.near.resize(group.condensed().numCrosspoints(), static_cast<Eigen::Index>(group.members().size()));
    for (Eigen::Index member = 0; member < block.near.cols(); ++member) {
      const auto crosspoints = group.crosspointIndices(static_cast<std::size_t>(member));
      for (Eigen::Index c = 0; c < block.near.rows(); ++c)
        block.near(c, member) = crosspoints_.nearIndexOf(crosspoints[static_cast<std::size_t>(c)]);
    }
    if ((block.near.array() < 0).all())
      block.near.resize(0, 0); // contact touches no crosspoint of the members' bodies
  }
}

/// Lets the boundaries that follow one crosspoint value after the other come apart, and constrains that. Collective.
void DualPreconditioner::constrainCrosspoints(const decomposition::DecomposedProblem& problem,
                                              const DeflatedDualOperator& deflated) {
  const Eigen::Index size = crosspoints_.size();
  prepareColumns(size);
  nearDisplacement_ = crosspoints_.extension();
  subtractJumps();
  smooth_->scale(-1.0); // J
  const std::span<double> entries = output_.values(static_cast<std::size_t>(size));
  std::fill(entries.begin(), entries.end(), 0.0);
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint) {
      const auto& all = subdomain.crosspointUnknowns; // ascending
      const auto found = std::lower_bound(all.begin(), all.end(), entry.unknown);
      if (found == all.end() || *found != entry.unknown)
        continue;
      const auto coarse = subdomain.crosspointIndices[static_cast<std::size_t>(found - all.begin())];
      entries[static_cast<std::size_t>(entry.multiplier) +
              static_cast<std::size_t>(crosspoints_.indexOf(coarse)) * entries.size() /
                  static_cast<std::size_t>(size)] += entry.coefficient;
    }
  output_.sumToOwners(*result_); // B_C
  constrained_.emplace(deflated, *smooth_, *result_, crosspoints_.stiffness());
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

std::size_t DualPreconditioner::bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_)
    bytes += block.stiffness->bytes();
  return bytes;
}

} // namespace epafi::fetidp
