#include "epafi/fetidp/SubdomainSolver.hpp"

#include <algorithm>

namespace epafi::fetidp {
namespace {

using decomposition::SparseMatrix;

/// The block of a sparse matrix with the given rows and columns; both lists ascending.
SparseMatrix block(const SparseMatrix& matrix, const std::vector<int>& rows,
                   const std::vector<int>& columns) {
  std::vector<int> position(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i)
    position[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  SparseMatrix result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  result.reserve(matrix.nonZeros());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    result.startVec(static_cast<Eigen::Index>(j));
    for (SparseMatrix::InnerIterator entry(matrix, columns[j]); entry; ++entry) {
      const int row = position[static_cast<std::size_t>(entry.row())];
      if (row >= 0)
        result.insertBack(row, static_cast<Eigen::Index>(j)) = entry.value();
    }
  }
  result.finalize();
  result.makeCompressed();
  return result;
}

} // namespace

SubdomainSolver::SubdomainSolver(const decomposition::Subdomain& subdomain, const std::string& directSolver)
    : subdomain_(&subdomain) {
  const auto& remainder = subdomain.remainderUnknowns;
  const auto& crosspoints = subdomain.crosspointUnknowns;
  factor_ = direct::factorize(block(subdomain.stiffness, remainder, remainder), directSolver,
                              "subdomain " + std::to_string(subdomain.number));
  remainderToCrosspoint_ = block(subdomain.stiffness, remainder, crosspoints);
  remainder_.resize(static_cast<Eigen::Index>(remainder.size()));
  solution_.resizeLike(remainder_);
  localCoarse_.resize(static_cast<Eigen::Index>(crosspoints.size()));
  splitConstraint();
  condense();
}

/// B = [B_r B_c] with rows numbered within the subdomain; W starts as B_c.
void SubdomainSolver::splitConstraint() {
  const auto numUnknowns = static_cast<std::size_t>(subdomain_->stiffness.rows());
  std::vector<int> remainderOf(numUnknowns, -1), crosspointOf(numUnknowns, -1);
  for (std::size_t i = 0; i < subdomain_->remainderUnknowns.size(); ++i)
    remainderOf[static_cast<std::size_t>(subdomain_->remainderUnknowns[i])] = static_cast<int>(i);
  for (std::size_t i = 0; i < subdomain_->crosspointUnknowns.size(); ++i)
    crosspointOf[static_cast<std::size_t>(subdomain_->crosspointUnknowns[i])] = static_cast<int>(i);

  for (const auto& entry : subdomain_->constraint)
    multipliers_.push_back(entry.multiplier);
  std::sort(multipliers_.begin(), multipliers_.end());
  multipliers_.erase(std::unique(multipliers_.begin(), multipliers_.end()), multipliers_.end());
  local_.resize(static_cast<Eigen::Index>(multipliers_.size()));
  flexibility_.resizeLike(local_);

  coupling_ = Eigen::MatrixXd::Zero(local_.size(), localCoarse_.size());
  for (const auto& entry : subdomain_->constraint) {
    const auto found = std::lower_bound(multipliers_.begin(), multipliers_.end(), entry.multiplier);
    const int row = static_cast<int>(found - multipliers_.begin());
    const int remainder = remainderOf[static_cast<std::size_t>(entry.unknown)];
    if (remainder >= 0)
      remainderConstraint_.push_back({row, remainder, entry.coefficient});
    else
      coupling_(row, crosspointOf[static_cast<std::size_t>(entry.unknown)]) += entry.coefficient;
  }
}

/// W = B_c − B_r Ψ and S = K_cc − K_cr Ψ with Ψ = K_rr⁻¹ K_rc.
void SubdomainSolver::condense() {
  const Eigen::MatrixXd rhs(remainderToCrosspoint_);
  Eigen::MatrixXd psi(rhs.rows(), rhs.cols());
  factor_->solve(rhs, psi);
  for (const Entry& entry : remainderConstraint_)
    coupling_.row(entry.row) -= entry.coefficient * psi.row(entry.column);

  schurComplement_ = Eigen::MatrixXd(
      block(subdomain_->stiffness, subdomain_->crosspointUnknowns, subdomain_->crosspointUnknowns));
  schurComplement_ -= remainderToCrosspoint_.transpose() * psi;
  schurComplement_ =
      (0.5 * (schurComplement_ + schurComplement_.transpose())).eval(); // symmetric to the last digit
}

void SubdomainSolver::applyFlexibility(std::span<const double> lambda, std::span<AccurateSum> coarse) {
  for (std::size_t i = 0; i < multipliers_.size(); ++i)
    local_[static_cast<Eigen::Index>(i)] = lambda[static_cast<std::size_t>(multipliers_[i])];

  localCoarse_.noalias() = coupling_.transpose() * local_; // Wᵀ λ
  addToCoarse(coarse);

  flexibility_.setZero();
  if (remainderConstraint_.empty())
    return;
  remainder_.setZero();
  for (const Entry& entry : remainderConstraint_) // B_rᵀ λ
    remainder_[entry.column] += entry.coefficient * local_[entry.row];
  factor_->solve(remainder_, solution_);
  for (const Entry& entry : remainderConstraint_) // B_r K_rr⁻¹ B_rᵀ λ
    flexibility_[entry.row] += entry.coefficient * solution_[entry.column];
}

void SubdomainSolver::applyCoupling(const Eigen::VectorXd& coarse, std::span<double> result) const {
  takeFromCoarse(coarse);
  local_ = flexibility_;
  local_.noalias() += coupling_ * localCoarse_; // + W x_c
  for (std::size_t i = 0; i < multipliers_.size(); ++i)
    result[static_cast<std::size_t>(multipliers_[i])] += local_[static_cast<Eigen::Index>(i)];
}

/// coarse += L_cᵀ localCoarse_.
void SubdomainSolver::addToCoarse(std::span<AccurateSum> coarse) const {
  const auto indices = crosspointIndices();
  for (std::size_t i = 0; i < indices.size(); ++i)
    coarse[static_cast<std::size_t>(indices[i])].add(localCoarse_[static_cast<Eigen::Index>(i)]);
}

/// localCoarse_ = L_c x_c.
void SubdomainSolver::takeFromCoarse(const Eigen::VectorXd& coarse) const {
  const auto indices = crosspointIndices();
  for (std::size_t i = 0; i < indices.size(); ++i)
    localCoarse_[static_cast<Eigen::Index>(i)] = coarse[static_cast<Eigen::Index>(indices[i])];
}

void SubdomainSolver::eliminate(const Eigen::VectorXd& b, std::span<AccurateSum> coarse) {
  for (Eigen::Index i = 0; i < remainder_.size(); ++i)
    remainder_[i] = b[subdomain_->remainderUnknowns[static_cast<std::size_t>(i)]];
  factor_->solve(remainder_, solution_);
  for (Eigen::Index i = 0; i < localCoarse_.size(); ++i)
    localCoarse_[i] = b[subdomain_->crosspointUnknowns[static_cast<std::size_t>(i)]];
  localCoarse_.noalias() -= remainderToCrosspoint_.transpose() * solution_; // b_c − K_cr y
  addToCoarse(coarse);
}

void SubdomainSolver::substitute(const Eigen::VectorXd& coarse, Eigen::VectorXd& u) {
  u.resize(subdomain_->stiffness.rows());
  takeFromCoarse(coarse);
  const Eigen::VectorXd y = solution_;
  remainder_.noalias() = remainderToCrosspoint_ * localCoarse_;
  factor_->solve(remainder_, solution_);
  for (Eigen::Index i = 0; i < remainder_.size(); ++i)
    u[subdomain_->remainderUnknowns[static_cast<std::size_t>(i)]] = y[i] - solution_[i];
  for (Eigen::Index i = 0; i < localCoarse_.size(); ++i)
    u[subdomain_->crosspointUnknowns[static_cast<std::size_t>(i)]] = localCoarse_[i];
}

void SubdomainSolver::subtractForces(std::span<const double> lambda, Eigen::VectorXd& b) const {
  for (const auto& entry : subdomain_->constraint)
    b[entry.unknown] -= entry.coefficient * lambda[static_cast<std::size_t>(entry.multiplier)];
}

void SubdomainSolver::addConstraint(const Eigen::VectorXd& u, std::span<double> result) const {
  for (const auto& entry : subdomain_->constraint)
    result[static_cast<std::size_t>(entry.multiplier)] += entry.coefficient * u[entry.unknown];
}

std::size_t SubdomainSolver::factorBytes() const {
  return factor_->bytes();
}

} // namespace epafi::fetidp
