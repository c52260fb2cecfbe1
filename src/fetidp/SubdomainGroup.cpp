#include "epafi/fetidp/SubdomainGroup.hpp"

#include <algorithm>
#include <utility>

namespace epafi::fetidp {
namespace {

/// Columns solved for at once.
constexpr Eigen::Index batch = 4;

} // namespace

SubdomainGroup::SubdomainGroup(const std::vector<decomposition::Subdomain>& subdomains,
                               IdenticalSubdomains identical, std::span<const GlobalOrdinal> crosspoints,
                               direct::Factorizer& factorizer)
    : subdomains_(&subdomains), members_(std::move(identical.members)),
      numOnAllRanks_(identical.numOnAllRanks),
      use_(identical.isShared() ? direct::SymmetricBlock::Use::shared : direct::SymmetricBlock::Use::alone),
      condensed_(subdomains[members_.front()], interfaceOf(subdomains[members_.front()]), factorizer),
      firstEntry_{0} {
  const std::vector<int>& positionOf = condensed_.interface().positionOf;
  for (const std::size_t member : members_) {
    for (const auto& entry : subdomains[member].constraint)
      entries_.push_back(
          {entry.multiplier, positionOf[static_cast<std::size_t>(entry.unknown)], entry.coefficient});
    firstEntry_.push_back(entries_.size());
  }
  boundary_.resize(condensed_.numBoundary(), numMembers());
  response_.resizeLike(boundary_);
  coarseLocal_.resize(condensed_.numCrosspoints(), numMembers());
  coarseIndices_.resize(condensed_.numCrosspoints(), numMembers());
  for (Eigen::Index member = 0; member < numMembers(); ++member) {
    const auto unknowns = crosspointIndices(static_cast<std::size_t>(member));
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      coarseIndices_(static_cast<Eigen::Index>(i), member) = static_cast<int>(
          std::lower_bound(crosspoints.begin(), crosspoints.end(), unknowns[i]) - crosspoints.begin());
  }
}

void SubdomainGroup::makeExplicit() {
  if (isExplicit_)
    return;
  flexibility_ = direct::SymmetricBlock(condensed_.factor().inverseOfKept(), use_);
  isExplicit_ = true;
}

void SubdomainGroup::applyFlexibility(std::span<const double> lambda, std::span<AccurateSum> coarse) {
  const int numBoundary = static_cast<int>(condensed_.numBoundary());
  const std::vector<int>& touched = condensed_.interface().crosspoints;
  boundary_.setZero();
  coarseLocal_.setZero();
  for (Eigen::Index member = 0; member < numMembers(); ++member)
    for (const InterfaceEntry& entry : entries(static_cast<std::size_t>(member))) {
      const double value = entry.coefficient * lambda[static_cast<std::size_t>(entry.multiplier)];
      if (entry.position < numBoundary)
        boundary_(entry.position, member) += value; // B_Δᵀ λ
      else
        coarseLocal_(touched[static_cast<std::size_t>(entry.position - numBoundary)], member) += value;
    }
  for (Eigen::Index member = 0; member < numMembers(); ++member) // column by column: see SymmetricBlock::Use
    coarseLocal_.col(member).noalias() -=
        condensed_.boundaryResponse().transpose() * boundary_.col(member); // Wᵀ λ
  addToCoarse(coarse);
  if (isExplicit_)
    flexibility_.apply(boundary_, response_);
  else
    solveForBoundary();
}

/// Number of members, from `first` on, that are solved for at once; makes their work space, 0 in columns to spare. A
/// shared factor always gets as many columns: CHOLMOD adds in another order for fewer.
Eigen::Index SubdomainGroup::prepareBatch(Eigen::Index first) {
  const Eigen::Index columns = std::min(batch, numMembers() - first);
  const Eigen::Index width = use_ == direct::SymmetricBlock::Use::alone ? columns : batch;
  if (rhs_.cols() != width) {
    rhs_.resize(condensed_.numRemainders(), width);
    solution_.resizeLike(rhs_);
  }
  rhs_.rightCols(width - columns).setZero();
  return columns;
}

/// (K_rr⁻¹)_ΔΔ B_Δᵀ λ by sparse solves.
void SubdomainGroup::solveForBoundary() {
  const std::vector<int>& positions = condensed_.interface().boundary;
  for (Eigen::Index first = 0; first < numMembers(); first += batch) {
    const Eigen::Index columns = prepareBatch(first);
    rhs_.setZero();
    rhs_.leftCols(columns)(positions, Eigen::all) = boundary_.middleCols(first, columns);
    condensed_.factor().solve(rhs_, solution_);
    response_.middleCols(first, columns) = solution_.leftCols(columns)(positions, Eigen::all);
  }
}

void SubdomainGroup::applyCoupling(const Eigen::VectorXd& coarse, std::span<double> result) {
  takeFromCoarse(coarse);
  for (Eigen::Index member = 0; member < numMembers(); ++member)
    response_.col(member).noalias() -= condensed_.boundaryResponse() * coarseLocal_.col(member);
  const int numBoundary = static_cast<int>(condensed_.numBoundary());
  const std::vector<int>& touched = condensed_.interface().crosspoints;
  for (Eigen::Index member = 0; member < numMembers(); ++member)
    for (const InterfaceEntry& entry : entries(static_cast<std::size_t>(member)))
      result[static_cast<std::size_t>(entry.multiplier)] +=
          entry.coefficient *
          (entry.position < numBoundary
               ? response_(entry.position, member)
               : coarseLocal_(touched[static_cast<std::size_t>(entry.position - numBoundary)], member));
}

/// coarse += Σ L_cᵀ of the members' columns.
void SubdomainGroup::addToCoarse(std::span<AccurateSum> coarse) const {
  for (Eigen::Index i = 0; i < coarseIndices_.size(); ++i)
    coarse[static_cast<std::size_t>(coarseIndices_.data()[i])].add(coarseLocal_.data()[i]);
}

/// The members' columns = L_c x_c.
void SubdomainGroup::takeFromCoarse(const Eigen::VectorXd& coarse) {
  for (Eigen::Index i = 0; i < coarseIndices_.size(); ++i)
    coarseLocal_.data()[i] = coarse[coarseIndices_.data()[i]];
}

void SubdomainGroup::eliminate(const std::vector<Eigen::VectorXd>& b, std::span<AccurateSum> coarse) {
  const decomposition::Subdomain& like = (*subdomains_)[members_.front()];
  for (Eigen::Index first = 0; first < numMembers(); first += batch) {
    const Eigen::Index columns = prepareBatch(first);
    for (Eigen::Index j = 0; j < columns; ++j) {
      const Eigen::VectorXd& forces = b[members_[static_cast<std::size_t>(first + j)]];
      rhs_.col(j) = forces(like.remainderUnknowns);
      coarseLocal_.col(first + j) = forces(like.crosspointUnknowns);
      coarseLocal_.col(first + j).noalias() -= condensed_.crosspointResponse().transpose() * rhs_.col(j);
    }
  }
  addToCoarse(coarse);
}

void SubdomainGroup::substitute(const Eigen::VectorXd& coarse, const std::vector<Eigen::VectorXd>& b,
                                std::vector<Eigen::VectorXd>& u) {
  const decomposition::Subdomain& like = (*subdomains_)[members_.front()];
  takeFromCoarse(coarse);
  for (Eigen::Index first = 0; first < numMembers(); first += batch) {
    const Eigen::Index columns = prepareBatch(first);
    for (Eigen::Index j = 0; j < columns; ++j)
      rhs_.col(j) = b[members_[static_cast<std::size_t>(first + j)]](like.remainderUnknowns);
    rhs_.leftCols(columns) -= condensed_.remainderToCrosspoint() * coarseLocal_.middleCols(first, columns);
    condensed_.factor().solve(rhs_, solution_);
    for (Eigen::Index j = 0; j < columns; ++j) {
      Eigen::VectorXd& values = u[members_[static_cast<std::size_t>(first + j)]];
      values.resize(like.stiffness.rows());
      values(like.remainderUnknowns) = solution_.col(j);
      values(like.crosspointUnknowns) = coarseLocal_.col(first + j);
    }
  }
}

void SubdomainGroup::subtractForces(std::span<const double> lambda, std::vector<Eigen::VectorXd>& b) const {
  for (const std::size_t member : members_)
    for (const auto& entry : (*subdomains_)[member].constraint)
      b[member][entry.unknown] -= entry.coefficient * lambda[static_cast<std::size_t>(entry.multiplier)];
}

void SubdomainGroup::addConstraint(const std::vector<Eigen::VectorXd>& u, std::span<double> result) const {
  for (const std::size_t member : members_)
    for (const auto& entry : (*subdomains_)[member].constraint)
      result[static_cast<std::size_t>(entry.multiplier)] += entry.coefficient * u[member][entry.unknown];
}

std::size_t SubdomainGroup::factorBytes() const {
  return condensed_.factor().bytes() + flexibility_.bytes();
}

std::size_t SubdomainGroup::applyBytes() const {
  return isExplicit_ ? flexibility_.bytes() : 2 * condensed_.factor().bytes();
}

} // namespace epafi::fetidp
