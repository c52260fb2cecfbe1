#include "epafi/fetidp/DualPreconditioner.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Columns.hpp"

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
  for (Eigen::Index column = 0; column < subdomain.stiffness.cols(); ++column) {
    const int j = positionOf[static_cast<std::size_t>(column)];
    if (j < 0 || j >= size)
      continue;
    for (decomposition::SparseMatrix::InnerIterator entry(subdomain.stiffness, column); entry; ++entry)
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
      touchedSums_(static_cast<std::size_t>(crosspoints_.size())),
      nearSums_(static_cast<std::size_t>(crosspoints_.extension().rows())),
      displacement_(crosspoints_.size()), forces_(crosspoints_.size()),
      nearDisplacement_(crosspoints_.extension().rows()), nearForces_(nearDisplacement_.size()),
      input_(problem), output_(problem), result_(map_) {
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
    const auto numMembers = static_cast<Eigen::Index>(groups[g].members().size());
    const auto precision = isSingle ? Precision::single : Precision::full;
    blocks_.push_back({g, direct::SymmetricBlock(matrix, groups[g].use(), precision), {}, {}, {}});
    blocks_.back().input.resize(matrix.rows(), numMembers);
    blocks_.back().output.resizeLike(blocks_.back().input);
  }
}

/// The diagonal of K̄ at the crosspoint values that contact touches: B has an entry for one copy of each, whose own
/// stiffness may be far from that of all. Collective.
Eigen::VectorXd DualPreconditioner::crosspointStiffness(const decomposition::DecomposedProblem& problem) {
  std::fill(touchedSums_.begin(), touchedSums_.end(), AccurateSum());
  for (const auto& subdomain : problem.subdomains)
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      if (const int touched = crosspoints_.indexOf(subdomain.crosspointIndices[i]); touched >= 0) {
        const int unknown = subdomain.crosspointUnknowns[i];
        touchedSums_[static_cast<std::size_t>(touched)].add(subdomain.stiffness.coeff(unknown, unknown));
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
    const auto& crosspoints = subdomain.crosspointUnknowns; // ascending
    const auto found = std::lower_bound(crosspoints.begin(), crosspoints.end(), unknown);
    if (found != crosspoints.end() && *found == unknown)
      return atCrosspoints[crosspoints_.indexOf(
          subdomain.crosspointIndices[static_cast<std::size_t>(found - crosspoints.begin())])];
    return subdomain.stiffness.coeff(unknown, unknown);
  };
  const std::span<double> sums = output_.values();
  std::fill(sums.begin(), sums.end(), 0.0);
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      sums[static_cast<std::size_t>(entry.multiplier)] +=
          entry.coefficient * entry.coefficient / stiffnessAt(subdomain, entry.unknown);
  output_.sumToOwners(result_);
  const auto total = result_.getData();
  for (Teuchos_Ordinal row = 0; row < total.size(); ++row)
    if (total[row] == 0)
      untouched_.push_back(static_cast<int>(row));

  const std::span<const double> totals = input_.toSubdomains(result_);
  for (Block& block : blocks_)
    for (const std::size_t member : std::as_const(*inverse_).groups()[block.group].members())
      for (const auto& entry : problem.subdomains[member].constraint)
        block.weights.push_back(entry.coefficient / stiffnessAt(problem.subdomains[member], entry.unknown) /
                                totals[static_cast<std::size_t>(entry.multiplier)]);
}

void DualPreconditioner::findFollowers(const decomposition::DecomposedProblem& problem) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[blocks_[b].group];
    for (std::size_t member = 0; member < group.members().size(); ++member) {
      Follower follower{b, static_cast<Eigen::Index>(member), {}, {}, {}};
      for (const InterfaceEntry& entry : group.entries(member))
        if (problem.multiplierGhostMap->getGlobalElement(entry.multiplier) < problem.numInequalities &&
            entry.position < group.condensed().numBoundary())
          follower.boundary.push_back(entry.position);
      if (follower.boundary.empty())
        continue;
      std::sort(follower.boundary.begin(),
                follower.boundary.end()); // where two contacts meet, an unknown is in both
      follower.boundary.erase(std::unique(follower.boundary.begin(), follower.boundary.end()),
                              follower.boundary.end());
      for (const GlobalOrdinal crosspoint : group.crosspointIndices(member))
        follower.crosspoints.push_back(crosspoints_.nearIndexOf(crosspoint));
      follower.response = group.condensed().boundaryResponse()(follower.boundary, Eigen::all);
      followers_.push_back(std::move(follower));
    }
  }
}

/// B_Dᵀ λ: the members' inputs, and `displacement_` summed over the ranks.
void DualPreconditioner::gather(std::span<const double> lambda) const {
  std::fill(touchedSums_.begin(), touchedSums_.end(), AccurateSum());
  for (Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    const auto numBoundary = static_cast<int>(block.input.rows());
    const std::vector<int>& touched = group.condensed().interface().crosspoints;
    block.input.setZero();
    const double* weight = block.weights.data();
    for (std::size_t member = 0; member < group.members().size(); ++member)
      for (const InterfaceEntry& entry : group.entries(member)) {
        const double value = *weight++ * lambda[static_cast<std::size_t>(entry.multiplier)];
        if (entry.position < numBoundary)
          block.input(entry.position, static_cast<Eigen::Index>(member)) += value;
        else
          touchedSums_[static_cast<std::size_t>(
                           crosspoints_.indexOf(group.crosspointIndices(member)[static_cast<std::size_t>(
                               touched[static_cast<std::size_t>(entry.position - numBoundary)])]))]
              .add(value);
      }
  }
  if (touchedSums_.empty())
    return;
  sumOverRanks(*map_->getComm(), touchedSums_);
  for (std::size_t i = 0; i < touchedSums_.size(); ++i)
    displacement_[static_cast<Eigen::Index>(i)] = touchedSums_[i].value();
}

/// Takes from the displacement of the edges what follows their crosspoints: u_Δ + Ψ_Δ u_c is left.
void DualPreconditioner::followCrosspoints() const {
  if (touchedSums_.empty())
    return;
  nearDisplacement_.noalias() = crosspoints_.extension() * displacement_;
  for (const Follower& follower : followers_)
    for (std::size_t j = 0; j < follower.crosspoints.size(); ++j)
      for (std::size_t i = 0; i < follower.boundary.size(); ++i)
        blocks_[follower.block].input(follower.boundary[i], follower.member) +=
            follower.response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
            nearDisplacement_[follower.crosspoints[j]];
}

/// Forces at the boundaries, and at the crosspoints that contact touches: Ŝ u_c, and what the boundaries pass on, Ψ_Δᵀ of
/// theirs.
void DualPreconditioner::multiply() const {
  for (Block& block : blocks_)
    block.stiffness.apply(block.input, block.output);
  if (touchedSums_.empty())
    return;
  std::fill(nearSums_.begin(), nearSums_.end(), AccurateSum());
  for (const Follower& follower : followers_)
    for (std::size_t j = 0; j < follower.crosspoints.size(); ++j)
      for (std::size_t i = 0; i < follower.boundary.size(); ++i)
        nearSums_[static_cast<std::size_t>(follower.crosspoints[j])].add(
            follower.response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
            blocks_[follower.block].output(follower.boundary[i], follower.member));
  sumOverRanks(*map_->getComm(), nearSums_);
  for (std::size_t i = 0; i < nearSums_.size(); ++i)
    nearForces_[static_cast<Eigen::Index>(i)] = nearSums_[i].value();
  forces_.noalias() = crosspoints_.stiffness() * displacement_;
  forces_.noalias() += crosspoints_.extension().transpose() * nearForces_;
}

/// B_D times the forces.
void DualPreconditioner::scatter(std::span<double> result) const {
  std::fill(result.begin(), result.end(), 0.0);
  for (const Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    const auto numBoundary = static_cast<int>(block.output.rows());
    const std::vector<int>& touched = group.condensed().interface().crosspoints;
    const double* weight = block.weights.data();
    for (std::size_t member = 0; member < group.members().size(); ++member)
      for (const InterfaceEntry& entry : group.entries(member))
        result[static_cast<std::size_t>(entry.multiplier)] +=
            *weight++ *
            (entry.position < numBoundary
                 ? block.output(entry.position, static_cast<Eigen::Index>(member))
                 : forces_[crosspoints_.indexOf(group.crosspointIndices(member)[static_cast<std::size_t>(
                       touched[static_cast<std::size_t>(entry.position - numBoundary)])])]);
  }
}

void DualPreconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                               double beta) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    gather(input_.toSubdomains(in));
    followCrosspoints();
    multiply();
    scatter(output_.values());
    output_.sumToOwners(result_);
    if (!untouched_.empty()) {
      const auto result = result_.getDataNonConst();
      const auto given = in.getData();
      for (const int row : untouched_)
        result[row] = given[row];
    }
    out.update(alpha, result_, beta);
  });
}

std::size_t DualPreconditioner::bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_)
    bytes += block.stiffness.bytes();
  return bytes;
}

} // namespace epafi::fetidp
