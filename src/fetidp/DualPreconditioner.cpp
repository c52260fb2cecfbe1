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
      result_(rcp(new MultiVector(map_, 1))) {
  collectively(*problem.comm, [&] { makeBlocks(problem, parameters.type, parameters.isSingle); });
  scale(problem, parameters.scaling);
  findFollowers(problem);
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
    blocks_.push_back({g, direct::SymmetricBlock(matrix, groups[g].use(), precision), {}, {}, {}});
  }
}

/// The diagonal of K̄ at the crosspoint values that contact touches: B has an entry for one copy of each, whose own
/// stiffness may be far from that of all. Collective.
Eigen::VectorXd DualPreconditioner::crosspointStiffness(const decomposition::DecomposedProblem& problem) {
  touchedSums_.assign(static_cast<std::size_t>(crosspoints_.size()), AccurateSum());
  for (const auto& subdomain : problem.subdomains)
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      if (const int touched = crosspoints_.indexOf(subdomain.crosspointIndices[i]); touched >= 0) {
        const int unknown = subdomain.crosspointUnknowns[i];
        touchedSums_[static_cast<std::size_t>(touched)].add(subdomain.stiffness->coeff(unknown, unknown));
      }
  sumOverRanks(*map_->getComm(), touchedSums_);
  Eigen::VectorXd diagonal(crosspoints_.size());
  for (std::size_t i = 0; i < touchedSums_.size(); ++i)
    diagonal[static_cast<Eigen::Index>(i)] = touchedSums_[i].value();
  return diagonal;
}

/// The weights (b_i/δ_i) / Σ_k b_k²/δ_k. Collective.
void DualPreconditioner::scale(const decomposition::DecomposedProblem& problem,
                               PreconditionerParameters::Scaling scaling) {
  const Eigen::VectorXd atCrosspoints = crosspointStiffness(problem);
  const auto stiffnessAt = [&](const decomposition::Subdomain& subdomain, int unknown) {
    if (scaling == PreconditionerParameters::Scaling::multiplicity)
      return 1.0;
    if (const auto& crosspoints = subdomain.crosspointUnknowns; // ascending
        std::binary_search(crosspoints.begin(), crosspoints.end(), unknown))
      return atCrosspoints[touchedIndexOf(subdomain, unknown)];
    return subdomain.stiffness->coeff(unknown, unknown);
  };
  const std::span<double> sums = output_.values();
  std::fill(sums.begin(), sums.end(), 0.0);
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      sums[static_cast<std::size_t>(entry.multiplier)] +=
          entry.coefficient * entry.coefficient / stiffnessAt(subdomain, entry.unknown);
  output_.sumToOwners(*result_);
  const auto total = result_->getData(0);
  for (Teuchos_Ordinal row = 0; row < total.size(); ++row)
    if (total[row] == 0)
      untouched_.push_back(static_cast<int>(row));

  const std::span<const double> totals = input_.toSubdomains(*result_);
  for (Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    for (const std::size_t member : group.members()) {
      const decomposition::Subdomain& subdomain = problem.subdomains[member];
      for (const auto& entry : subdomain.constraint) {
        const double weight = entry.coefficient / stiffnessAt(subdomain, entry.unknown) /
                              totals[static_cast<std::size_t>(entry.multiplier)];
        if (group.condensed().interface().positionOf[static_cast<std::size_t>(entry.unknown)] <
            group.condensed().numBoundary())
          block.weights.push_back(weight);
        else
          crosspointEntries_.push_back({entry.multiplier, touchedIndexOf(subdomain, entry.unknown), weight});
      }
    }
  }
}

/// Index among the crosspoint values that contact touches, of an unknown that is one.
int DualPreconditioner::touchedIndexOf(const decomposition::Subdomain& subdomain, int unknown) const {
  const auto& crosspoints = subdomain.crosspointUnknowns; // ascending
  const auto found = std::lower_bound(crosspoints.begin(), crosspoints.end(), unknown);
  return crosspoints_.indexOf(
      subdomain.crosspointIndices[static_cast<std::size_t>(found - crosspoints.begin())]);
}

void DualPreconditioner::findFollowers(const decomposition::DecomposedProblem& problem) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[blocks_[b].group];
    const auto numMembers = static_cast<Eigen::Index>(group.members().size());
    for (Eigen::Index member = 0; member < numMembers; ++member) {
      Follower follower{b, member, numMembers, {}, {}, {}};
      for (const auto& entry :
           problem.subdomains[group.members()[static_cast<std::size_t>(member)]].constraint) {
        const int position =
            group.condensed().interface().positionOf[static_cast<std::size_t>(entry.unknown)];
        if (problem.multiplierGhostMap->getGlobalElement(entry.multiplier) < problem.numInequalities &&
            position < group.condensed().numBoundary())
          follower.boundary.push_back(position);
      }
      if (follower.boundary.empty())
        continue;
      std::sort(follower.boundary.begin(),
                follower.boundary.end()); // where two contacts meet, an unknown is in both
      follower.boundary.erase(std::unique(follower.boundary.begin(), follower.boundary.end()),
                              follower.boundary.end());
      for (const GlobalOrdinal crosspoint : group.crosspointIndices(static_cast<std::size_t>(member)))
        follower.crosspoints.push_back(crosspoints_.nearIndexOf(crosspoint));
      follower.response = group.condensed().boundaryResponse()(follower.boundary, Eigen::all);
      followers_.push_back(std::move(follower));
    }
  }
}

/// Work space for k columns; sums and inputs begin at 0.
void DualPreconditioner::prepareColumns(Eigen::Index numColumns) const {
  for (Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    block.input.setZero(group.condensed().numBoundary(),
                        static_cast<Eigen::Index>(group.members().size()) * numColumns);
    block.output.resizeLike(block.input);
  }
  displacement_.resize(crosspoints_.size(), numColumns);
  forces_.resizeLike(displacement_);
  nearDisplacement_.resize(crosspoints_.extension().rows(), numColumns);
  nearForces_.resizeLike(nearDisplacement_);
  touchedSums_.assign(static_cast<std::size_t>(displacement_.size()), AccurateSum());
  nearSums_.assign(static_cast<std::size_t>(nearForces_.size()), AccurateSum());
}

/// B_Dᵀ λ: the members' inputs, and `displacement_` summed over the ranks.
void DualPreconditioner::gather(std::span<const double> lambda) const {
  const Eigen::Index numColumns = displacement_.cols();
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    const double* values = lambda.data() + j * static_cast<Eigen::Index>(lambda.size()) / numColumns;
    for (Block& block : blocks_) {
      double* input = block.input.data() + j * block.input.size() / numColumns;
      const double* weight = block.weights.data();
      for (const InterfaceEntry& entry : std::as_const(*inverse_).groups()[block.group].boundaryEntries())
        input[entry.place] += *weight++ * values[entry.multiplier];
    }
    for (const CrosspointEntry& entry : crosspointEntries_)
      touchedSums_[static_cast<std::size_t>(j * crosspoints_.size() + entry.touched)].add(
          entry.weight * values[entry.multiplier]);
  }
  if (touchedSums_.empty())
    return;
  sumOverRanks(*map_->getComm(), touchedSums_);
  for (std::size_t i = 0; i < touchedSums_.size(); ++i)
    displacement_.data()[i] = touchedSums_[i].value();
}

/// Takes from the displacement of the edges what follows their crosspoints: u_Δ + Ψ_Δ u_c is left.
void DualPreconditioner::followCrosspoints() const {
  if (touchedSums_.empty())
    return;
  nearDisplacement_.noalias() = crosspoints_.extension() * displacement_;
  for (Eigen::Index column = 0; column < displacement_.cols(); ++column)
    for (const Follower& follower : followers_)
      for (std::size_t j = 0; j < follower.crosspoints.size(); ++j)
        for (std::size_t i = 0; i < follower.boundary.size(); ++i)
          blocks_[follower.block].input(follower.boundary[i],
                                        follower.member + column * follower.numMembers) +=
              follower.response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
              nearDisplacement_(follower.crosspoints[j], column);
}

/// Forces at the boundaries, and at the crosspoints that contact touches: Ŝ u_c, and what the boundaries pass on, Ψ_Δᵀ of
/// theirs.
void DualPreconditioner::multiply() const {
  for (Block& block : blocks_)
    block.stiffness.apply(block.input, block.output);
  if (touchedSums_.empty())
    return;
  for (Eigen::Index column = 0; column < displacement_.cols(); ++column)
    for (const Follower& follower : followers_)
      for (std::size_t j = 0; j < follower.crosspoints.size(); ++j)
        for (std::size_t i = 0; i < follower.boundary.size(); ++i)
          nearSums_[static_cast<std::size_t>(column * nearForces_.rows() + follower.crosspoints[j])].add(
              follower.response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
              blocks_[follower.block].output(follower.boundary[i],
                                             follower.member + column * follower.numMembers));
  sumOverRanks(*map_->getComm(), nearSums_);
  for (std::size_t i = 0; i < nearSums_.size(); ++i)
    nearForces_.data()[i] = nearSums_[i].value();
  forces_.noalias() = crosspoints_.stiffness() * displacement_;
  forces_.noalias() += crosspoints_.extension().transpose() * nearForces_;
}

/// B_D times the forces.
void DualPreconditioner::scatter(std::span<double> result) const {
  std::fill(result.begin(), result.end(), 0.0);
  const Eigen::Index numColumns = displacement_.cols();
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    double* values = result.data() + j * static_cast<Eigen::Index>(result.size()) / numColumns;
    for (const Block& block : blocks_) {
      const double* output = block.output.data() + j * block.output.size() / numColumns;
      const double* weight = block.weights.data();
      for (const InterfaceEntry& entry : std::as_const(*inverse_).groups()[block.group].boundaryEntries())
        values[entry.multiplier] += *weight++ * output[entry.place];
    }
    for (const CrosspointEntry& entry : crosspointEntries_)
      values[entry.multiplier] += entry.weight * forces_(entry.touched, j);
  }
}

void DualPreconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                               double beta) const {
  const std::size_t numColumns = x.getNumVectors();
  if (result_->getNumVectors() != numColumns)
    result_ = rcp(new MultiVector(map_, numColumns));
  prepareColumns(static_cast<Eigen::Index>(numColumns));
  gather(input_.toSubdomains(x));
  followCrosspoints();
  multiply();
  scatter(output_.values(numColumns));
  output_.sumToOwners(*result_);
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
