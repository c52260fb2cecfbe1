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
                               direct::Factorizer& factorizer, const SubdomainGroup* previous)
    : subdomains_(&subdomains), members_(std::move(identical.members)),
      numOnAllRanks_(identical.numOnAllRanks),
      use_(identical.isShared() ? direct::SymmetricBlock::Use::shared : direct::SymmetricBlock::Use::alone) {
  const decomposition::Subdomain& first = subdomains[members_.front()];
  stiffness_ = first.stiffness;
  crosspointUnknowns_ = first.crosspointUnknowns;
  SubdomainInterface interface = interfaceOf(first);
  if (previous != nullptr && previous->fits(first, interface)) {
    condensed_ = previous->condensed_;
    if (previous->use_ == use_) {
      flexibility_ = previous->flexibility_;
      boundaryStiffness_ = previous->boundaryStiffness_;
    }
  } else {
    condensed_ = std::make_shared<const CondensedSubdomain>(
        first, std::move(interface), factorizer,
        previous != nullptr ? &previous->condensed_->factor() : nullptr);
  }
  for (std::size_t member = 0; member < members_.size(); ++member)
    addEntries(member, members_[member]);
  coarseIndices_.resize(condensed_->numCrosspoints(), numMembers());
  for (Eigen::Index member = 0; member < numMembers(); ++member) {
    const auto unknowns = crosspointIndices(static_cast<std::size_t>(member));
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      coarseIndices_(static_cast<Eigen::Index>(i), member) = static_cast<int>(
          std::lower_bound(crosspoints.begin(), crosspoints.end(), unknowns[i]) - crosspoints.begin());
  }
}

/// Whether the factor is that of a subdomain as it is now.
bool SubdomainGroup::fits(const decomposition::Subdomain& subdomain,
                          const SubdomainInterface& interface) const {
  return stiffness_.lock() == subdomain.stiffness && crosspointUnknowns_ == subdomain.crosspointUnknowns &&
         condensed_->interface() == interface;
}

void SubdomainGroup::addEntries(std::size_t member, std::size_t subdomain) {
  const SubdomainInterface& interface = condensed_->interface();
  const int numBoundary = static_cast<int>(condensed_->numBoundary()),
            numCrosspoints = static_cast<int>(condensed_->numCrosspoints()),
            column = static_cast<int>(member);
  for (const auto& entry : (*subdomains_)[subdomain].constraint) {
    const int position = interface.positionOf[static_cast<std::size_t>(entry.unknown)]; // among (Δ, C)
    if (position < numBoundary)
      boundaryEntries_.push_back({entry.multiplier, position + column * numBoundary, entry.coefficient});
    else
      crosspointEntries_.push_back(
          {entry.multiplier,
           interface.crosspoints[static_cast<std::size_t>(position - numBoundary)] + column * numCrosspoints,
           entry.coefficient});
  }
}

void SubdomainGroup::makeExplicit() {
  if (isExplicit_)
    return;
  if (!flexibility_)
    flexibility_ = std::make_shared<const direct::SymmetricBlock>(condensed_->factor().inverseOfKept(), use_);
  isExplicit_ = true;
}

std::shared_ptr<const direct::SymmetricBlock>
SubdomainGroup::boundaryStiffness(direct::SymmetricBlock::Precision precision) const {
  if (!boundaryStiffness_ || boundaryStiffness_->precision() != precision)
    boundaryStiffness_ = std::make_shared<const direct::SymmetricBlock>(
        condensed_->factor().schurComplement(), use_, precision);
  return boundaryStiffness_;
}

/// Work space for k columns.
void SubdomainGroup::prepareColumns(Eigen::Index numColumns) {
  boundary_.resize(condensed_->numBoundary(), numMembers() * numColumns);
  response_.resizeLike(boundary_);
  coarseLocal_.resize(condensed_->numCrosspoints(), boundary_.cols());
}

void SubdomainGroup::applyFlexibility(std::span<const double> lambda, std::span<AccurateSum> coarse,
                                      int numColumns) {
  prepareColumns(numColumns);
  boundary_.setZero();
  coarseLocal_.setZero();
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    const double* values = lambda.data() + j * static_cast<Eigen::Index>(lambda.size()) / numColumns;
    double *boundary = boundary_.data() + j * boundary_.size() / numColumns,
           *crosspoints = coarseLocal_.data() + j * coarseLocal_.size() / numColumns;
    for (const InterfaceEntry& entry : boundaryEntries_)
      boundary[entry.place] += entry.coefficient * values[entry.multiplier]; // B_Δᵀ λ
    for (const InterfaceEntry& entry : crosspointEntries_)
      crosspoints[entry.place] += entry.coefficient * values[entry.multiplier];
  }
  for (Eigen::Index column = 0; column < boundary_.cols(); ++column) // one by one: see SymmetricBlock::Use
    coarseLocal_.col(column).noalias() -=
        condensed_->boundaryResponse().transpose() * boundary_.col(column); // Wᵀ λ
  addToCoarse(coarse);
  if (isExplicit_)
    flexibility_->apply(boundary_, response_);
  else
    solveForBoundary();
}

/// Number of columns, from `first` on, that are solved for at once; makes their work space, 0 in columns to spare. A
/// shared factor always gets as many columns: CHOLMOD adds in another order for fewer.
Eigen::Index SubdomainGroup::prepareBatch(Eigen::Index first) {
  const Eigen::Index columns = std::min(batch, coarseLocal_.cols() - first);
  const Eigen::Index width = use_ == direct::SymmetricBlock::Use::alone ? columns : batch;
  if (rhs_.cols() != width) {
    rhs_.resize(condensed_->numRemainders(), width);
    solution_.resizeLike(rhs_);
  }
  rhs_.rightCols(width - columns).setZero();
  return columns;
}

/// (K_rr⁻¹)_ΔΔ B_Δᵀ λ by sparse solves.
void SubdomainGroup::solveForBoundary() {
  const std::vector<int>& positions = condensed_->interface().boundary;
  for (Eigen::Index first = 0; first < boundary_.cols(); first += batch) {
    const Eigen::Index columns = prepareBatch(first);
    rhs_.setZero();
    rhs_.leftCols(columns)(positions, Eigen::all) = boundary_.middleCols(first, columns);
    condensed_->factor().solve(rhs_, solution_);
    response_.middleCols(first, columns) = solution_.leftCols(columns)(positions, Eigen::all);
  }
}

void SubdomainGroup::applyCoupling(const Eigen::MatrixXd& coarse, std::span<double> result) {
  takeFromCoarse(coarse);
  for (Eigen::Index column = 0; column < response_.cols(); ++column)
    response_.col(column).noalias() -= condensed_->boundaryResponse() * coarseLocal_.col(column);
  for (Eigen::Index j = 0; j < coarse.cols(); ++j) {
    double* values = result.data() + j * static_cast<Eigen::Index>(result.size()) / coarse.cols();
    const double *boundary = response_.data() + j * response_.size() / coarse.cols(),
                 *crosspoints = coarseLocal_.data() + j * coarseLocal_.size() / coarse.cols();
    for (const InterfaceEntry& entry : boundaryEntries_)
      values[entry.multiplier] += entry.coefficient * boundary[entry.place];
    for (const InterfaceEntry& entry : crosspointEntries_)
      values[entry.multiplier] += entry.coefficient * crosspoints[entry.place];
  }
}

/// coarse += Σ L_cᵀ of the members' columns.
void SubdomainGroup::addToCoarse(std::span<AccurateSum> coarse) const {
  const Eigen::Index numColumns = coarseLocal_.cols() / numMembers();
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    AccurateSum* sums = coarse.data() + j * static_cast<Eigen::Index>(coarse.size()) / numColumns;
    const double* values = coarseLocal_.data() + j * coarseIndices_.size();
    for (Eigen::Index i = 0; i < coarseIndices_.size(); ++i)
      sums[coarseIndices_.data()[i]].add(values[i]);
  }
}

/// The members' columns = L_c x_c.
void SubdomainGroup::takeFromCoarse(const Eigen::MatrixXd& coarse) {
  for (Eigen::Index j = 0; j < coarse.cols(); ++j) {
    double* values = coarseLocal_.data() + j * coarseIndices_.size();
    for (Eigen::Index i = 0; i < coarseIndices_.size(); ++i)
      values[i] = coarse(coarseIndices_.data()[i], j);
  }
}

void SubdomainGroup::eliminate(const std::vector<Eigen::MatrixXd>& b, std::span<AccurateSum> coarse) {
  const decomposition::Subdomain& like = (*subdomains_)[members_.front()];
  const Eigen::Index numColumns = b[members_.front()].cols();
  coarseLocal_.resize(condensed_->numCrosspoints(), numMembers() * numColumns);
  Eigen::VectorXd remainders(condensed_->numRemainders());
  for (Eigen::Index column = 0; column < coarseLocal_.cols(); ++column) {
    const auto forces =
        b[members_[static_cast<std::size_t>(column % numMembers())]].col(column / numMembers());
    remainders = forces(like.remainderUnknowns);
    coarseLocal_.col(column) = forces(like.crosspointUnknowns);
    coarseLocal_.col(column).noalias() -= condensed_->crosspointResponse().transpose() * remainders;
  }
  addToCoarse(coarse);
}

void SubdomainGroup::substitute(const Eigen::MatrixXd& coarse, const std::vector<Eigen::MatrixXd>& b,
                                std::vector<Eigen::MatrixXd>& u) {
  const decomposition::Subdomain& like = (*subdomains_)[members_.front()];
  for (const std::size_t member : members_)
    u[member].resize(like.stiffness->rows(), coarse.cols());
  coarseLocal_.resize(condensed_->numCrosspoints(),
                      numMembers() * coarse.cols()); // not all callers eliminate before
  takeFromCoarse(coarse);
  for (Eigen::Index first = 0; first < coarseLocal_.cols(); first += batch) {
    const Eigen::Index columns = prepareBatch(first);
    for (Eigen::Index j = 0; j < columns; ++j)
      rhs_.col(j) = b[members_[static_cast<std::size_t>((first + j) % numMembers())]].col(
          (first + j) / numMembers())(like.remainderUnknowns);
    rhs_.leftCols(columns) -= condensed_->remainderToCrosspoint() * coarseLocal_.middleCols(first, columns);
    condensed_->factor().solve(rhs_, solution_);
    for (Eigen::Index j = 0; j < columns; ++j) {
      auto values =
          u[members_[static_cast<std::size_t>((first + j) % numMembers())]].col((first + j) / numMembers());
      values(like.remainderUnknowns) = solution_.col(j);
      values(like.crosspointUnknowns) = coarseLocal_.col(first + j);
    }
  }
}

void SubdomainGroup::takeCrosspoints(const std::vector<Eigen::MatrixXd>& u, Eigen::MatrixXd& coarse) const {
  const std::vector<int>& unknowns = (*subdomains_)[members_.front()].crosspointUnknowns;
  for (Eigen::Index member = 0; member < numMembers(); ++member)
    for (Eigen::Index i = 0; i < coarseIndices_.rows(); ++i)
      coarse.row(coarseIndices_(i, member)) =
          u[members_[static_cast<std::size_t>(member)]].row(unknowns[static_cast<std::size_t>(i)]);
}

void SubdomainGroup::subtractForces(std::span<const double> lambda, std::vector<Eigen::MatrixXd>& b) const {
  for (const std::size_t member : members_)
    for (Eigen::Index j = 0; j < b[member].cols(); ++j) {
      const double* values = lambda.data() + j * static_cast<Eigen::Index>(lambda.size()) / b[member].cols();
      for (const auto& entry : (*subdomains_)[member].constraint)
        b[member](entry.unknown, j) -= entry.coefficient * values[entry.multiplier];
    }
}

void SubdomainGroup::addConstraint(const std::vector<Eigen::MatrixXd>& u, std::span<double> result) const {
  for (const std::size_t member : members_)
    for (Eigen::Index j = 0; j < u[member].cols(); ++j) {
      double* values = result.data() + j * static_cast<Eigen::Index>(result.size()) / u[member].cols();
      for (const auto& entry : (*subdomains_)[member].constraint)
        values[entry.multiplier] += entry.coefficient * u[member](entry.unknown, j);
    }
}

std::size_t SubdomainGroup::factorBytes() const {
  return condensed_->factor().bytes() + (isExplicit_ ? flexibility_->bytes() : 0);
}

std::size_t SubdomainGroup::applyBytes() const {
  return isExplicit_ ? flexibility_->bytes() : 2 * condensed_->factor().bytes();
}

} // namespace epafi::fetidp
