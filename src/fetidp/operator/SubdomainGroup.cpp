#include "epafi/fetidp/operator/SubdomainGroup.hpp"

#include <algorithm>
#include <utility>

namespace epafi::fetidp {
namespace {

/// Columns solved for at once.
constexpr Eigen::Index batch = 4;

} // namespace

void addTransposed(std::span<const InterfaceEntry> b, std::span<const double> lambda, Eigen::Index numColumns,
                   Eigen::MatrixXd& values) {
  const Eigen::Index numMultipliers = std::ssize(lambda) / numColumns;
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    const double* multipliers = lambda.data() + j * numMultipliers;
    double* column = values.data() + j * values.size() / numColumns;
    for (const InterfaceEntry& entry : b)
      column[entry.place] += entry.coefficient * multipliers[entry.multiplier];
  }
}

void addProduct(std::span<const InterfaceEntry> b, const Eigen::MatrixXd& values, Eigen::Index numColumns,
                std::span<double> result) {
  const Eigen::Index numMultipliers = std::ssize(result) / numColumns;
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    double* multipliers = result.data() + j * numMultipliers;
    const double* column = values.data() + j * values.size() / numColumns;
    for (const InterfaceEntry& entry : b)
      multipliers[entry.multiplier] += entry.coefficient * column[entry.place];
  }
}

SubdomainGroup::SubdomainGroup(const std::vector<decomposition::Subdomain>& subdomains,
                               IdenticalSubdomains identical,
                               std::span<const decomposition::CoarseNumber> crosspoints,
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
        first, std::move(interface), identical.isShared(), factorizer,
        previous != nullptr ? &previous->condensed_->factor() : nullptr);
  }
  for (std::size_t member = 0; member < members_.size(); ++member)
    addEntries(member, members_[member]);
  coarseIndices_.resize(condensed_->numCrosspoints(), numMembers());
  for (Eigen::Index member = 0; member < numMembers(); ++member) {
    const auto unknowns = crosspointIndices(member);
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      coarseIndices_(i, member) = static_cast<int>(
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
    const int position = interface.positionOf[entry.unknown]; // among (Δ, C)
    if (position < numBoundary)
      boundaryEntries_.push_back({entry.multiplier, position + column * numBoundary, entry.coefficient});
    else
      crosspointEntries_.push_back({entry.multiplier,
                                    interface.crosspoints[position - numBoundary] + column * numCrosspoints,
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

CondensedBoundary SubdomainGroup::condensedBoundary() {
  using Block = direct::SymmetricBlock;
  const bool hasStiffness = boundaryStiffness_ && boundaryStiffness_->precision() == Block::Precision::full;
  CondensedBoundary boundary{hasStiffness ? boundaryStiffness_->matrix()
                                          : condensed_->factor().schurComplement(),
                             flexibility_ ? flexibility_->matrix() : condensed_->factor().inverseOfKept()};
  if (use_ == Block::Use::alone) { // as it is on any number of ranks
    if (!hasStiffness)
      boundaryStiffness_ = std::make_shared<const Block>(boundary.stiffness, use_);
    if (!flexibility_)
      flexibility_ = std::make_shared<const Block>(boundary.flexibility, use_);
    isExplicit_ = true;
  }
  return boundary;
}

std::shared_ptr<const direct::SymmetricBlock>
SubdomainGroup::boundaryStiffness(direct::SymmetricBlock::Precision precision) const {
  if (!boundaryStiffness_ || boundaryStiffness_->precision() != precision) {
    const bool isMoreExact = boundaryStiffness_ && precision == direct::SymmetricBlock::Precision::single;
    boundaryStiffness_ = std::make_shared<const direct::SymmetricBlock>(
        isMoreExact ? boundaryStiffness_->matrix() : condensed_->factor().schurComplement(), use_, precision);
  }
  return boundaryStiffness_;
}

void SubdomainGroup::applyFlexibility(std::span<const double> lambda, std::span<AccurateSum> coarse,
                                      int numColumns, Workspace& work) const {
  work.forces.setZero(condensed_->numBoundary(), numMembers() * numColumns);
  work.displacement.resizeLike(work.forces);
  work.crosspointForces.setZero(condensed_->numCrosspoints(), work.forces.cols());
  addTransposed(boundaryEntries_, lambda, numColumns, work.forces); // B_Δᵀ λ
  addTransposed(crosspointEntries_, lambda, numColumns, work.crosspointForces);
  for (Eigen::Index column = 0; column < work.forces.cols(); ++column) // one by one: see SymmetricBlock::Use
    work.crosspointForces.col(column).noalias() -=
        condensed_->boundaryResponse().transpose() * work.forces.col(column); // Wᵀ λ
  addToCoarse(work.crosspointForces, coarse);
  if (isExplicit_)
    flexibility_->apply(work.forces, work.displacement);
  else
    solveForBoundary(work);
}

/// Number of columns, of those left, that are solved for at once; makes their work space, 0 in columns to
/// spare. A shared factor always gets as many columns: CHOLMOD adds in another order for fewer.
Eigen::Index SubdomainGroup::prepareBatch(Eigen::Index numLeft, Workspace& work) const {
  const Eigen::Index columns = std::min(batch, numLeft);
  const Eigen::Index width = use_ == direct::SymmetricBlock::Use::alone ? columns : batch;
  work.rhs.resize(condensed_->numRemainders(), width);
  work.solution.resizeLike(work.rhs);
  work.rhs.rightCols(width - columns).setZero();
  return columns;
}

/// (K_rr⁻¹)_ΔΔ B_Δᵀ λ with the factor alone. Columns of constraints touch few subdomains.
void SubdomainGroup::solveForBoundary(Workspace& work) const {
  for (Eigen::Index column = 0; column < work.forces.cols(); ++column)
    if (work.forces.col(column).isZero(0))
      work.displacement.col(column).setZero();
    else
      condensed_->factor().solveKept(work.forces.col(column), work.displacement.col(column));
}

void SubdomainGroup::applyCoupling(const Eigen::MatrixXd& coarse, std::span<double> result,
                                   Workspace& work) const {
  takeFromCoarse(coarse, work.crosspointValues);
  for (Eigen::Index column = 0; column < work.displacement.cols(); ++column)
    work.displacement.col(column).noalias() -=
        condensed_->boundaryResponse() * work.crosspointValues.col(column);
  addProduct(boundaryEntries_, work.displacement, coarse.cols(), result);
  addProduct(crosspointEntries_, work.crosspointValues, coarse.cols(), result);
}

/// coarse += Σ L_cᵀ of the members' columns.
void SubdomainGroup::addToCoarse(const Eigen::MatrixXd& crosspointForces,
                                 std::span<AccurateSum> coarse) const {
  const Eigen::Index numColumns = crosspointForces.cols() / numMembers();
  for (Eigen::Index j = 0; j < numColumns; ++j) {
    AccurateSum* sums = coarse.data() + j * std::ssize(coarse) / numColumns;
    const double* values = crosspointForces.data() + j * coarseIndices_.size();
    for (Eigen::Index i = 0; i < coarseIndices_.size(); ++i)
      sums[coarseIndices_.data()[i]].add(values[i]);
  }
}

/// The members' columns: L_c x_c.
void SubdomainGroup::takeFromCoarse(const Eigen::MatrixXd& coarse, Eigen::MatrixXd& crosspointValues) const {
  crosspointValues.resize(condensed_->numCrosspoints(), numMembers() * coarse.cols());
  for (Eigen::Index j = 0; j < coarse.cols(); ++j) {
    double* values = crosspointValues.data() + j * coarseIndices_.size();
    for (Eigen::Index i = 0; i < coarseIndices_.size(); ++i)
      values[i] = coarse(coarseIndices_.data()[i], j);
  }
}

void SubdomainGroup::eliminate(const std::vector<Eigen::MatrixXd>& b, std::span<AccurateSum> coarse,
                               Workspace& work) const {
  const decomposition::Subdomain& like = (*subdomains_)[members_.front()];
  work.crosspointForces.resize(condensed_->numCrosspoints(), numMembers() * b[members_.front()].cols());
  if (condensed_->numCrosspoints() == 0)
    return;
  const Eigen::MatrixXd& response = condensed_->crosspointResponse(); // Ψ
  const bool isKept = response.size() > 0;
  for (Eigen::Index first = 0; first < work.crosspointForces.cols(); first += batch) {
    const Eigen::Index columns = prepareBatch(work.crosspointForces.cols() - first, work);
    for (Eigen::Index j = 0; j < columns; ++j)
      work.rhs.col(j) = columnOf(b, first + j)(like.remainderUnknowns);
    if (!isKept)
      condensed_->factor().solve(work.rhs, work.solution);
    for (Eigen::Index j = 0; j < columns; ++j) {
      auto forces = work.crosspointForces.col(first + j);
      forces = columnOf(b, first + j)(like.crosspointUnknowns);
      if (isKept)
        forces.noalias() -= response.transpose() * work.rhs.col(j);
      else
        forces.noalias() -= condensed_->remainderToCrosspoint().transpose() * work.solution.col(j);
    }
  }
  addToCoarse(work.crosspointForces, coarse);
}

void SubdomainGroup::substitute(const Eigen::MatrixXd& coarse, const std::vector<Eigen::MatrixXd>& b,
                                std::vector<Eigen::MatrixXd>& u, Workspace& work) const {
  const decomposition::Subdomain& like = (*subdomains_)[members_.front()];
  for (const std::size_t member : members_)
    u[member].resize(like.stiffness->rows(), coarse.cols());
  takeFromCoarse(coarse, work.crosspointValues);
  const Eigen::MatrixXd& values = work.crosspointValues;
  for (Eigen::Index first = 0; first < values.cols(); first += batch) {
    const Eigen::Index columns = prepareBatch(values.cols() - first, work);
    for (Eigen::Index j = 0; j < columns; ++j)
      work.rhs.col(j) = columnOf(b, first + j)(like.remainderUnknowns);
    work.rhs.leftCols(columns) -= condensed_->remainderToCrosspoint() * values.middleCols(first, columns);
    condensed_->factor().solve(work.rhs, work.solution);
    for (Eigen::Index j = 0; j < columns; ++j) {
      auto result = columnOf(u, first + j);
      result(like.remainderUnknowns) = work.solution.col(j);
      result(like.crosspointUnknowns) = values.col(first + j);
    }
  }
}

void SubdomainGroup::takeCrosspoints(const std::vector<Eigen::MatrixXd>& u, Eigen::MatrixXd& coarse) const {
  const std::vector<int>& unknowns = (*subdomains_)[members_.front()].crosspointUnknowns;
  for (Eigen::Index member = 0; member < numMembers(); ++member)
    for (Eigen::Index i = 0; i < coarseIndices_.rows(); ++i)
      coarse.row(coarseIndices_(i, member)) = u[members_[member]].row(unknowns[i]);
}

void SubdomainGroup::subtractForces(std::span<const double> lambda, std::vector<Eigen::MatrixXd>& b) const {
  for (const std::size_t member : members_)
    for (Eigen::Index j = 0; j < b[member].cols(); ++j) {
      const double* values = lambda.data() + j * std::ssize(lambda) / b[member].cols();
      for (const auto& entry : (*subdomains_)[member].constraint)
        b[member](entry.unknown, j) -= entry.coefficient * values[entry.multiplier];
    }
}

void SubdomainGroup::addConstraint(const std::vector<Eigen::MatrixXd>& u, std::span<double> result) const {
  for (const std::size_t member : members_)
    for (Eigen::Index j = 0; j < u[member].cols(); ++j) {
      double* values = result.data() + j * std::ssize(result) / u[member].cols();
      for (const auto& entry : (*subdomains_)[member].constraint)
        values[entry.multiplier] += entry.coefficient * u[member](entry.unknown, j);
    }
}

std::size_t SubdomainGroup::factorBytes() const {
  return condensed_->factor().bytes() + (isExplicit_ ? flexibility_->bytes() : 0);
}

std::size_t SubdomainGroup::applyBytes() const {
  return isExplicit_ ? flexibility_->bytes() : 2 * sizeof(double) * condensed_->factor().numKeptEntries();
}

} // namespace epafi::fetidp
