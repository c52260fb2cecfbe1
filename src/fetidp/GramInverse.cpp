#include "epafi/fetidp/GramInverse.hpp"

#include "epafi/base/Errors.hpp"

#include <utility>

namespace epafi::fetidp {
namespace {

constexpr double gatheringBytes = 1.5e5; ///< that are read while a small gathering passes: 15 µs at 10 GB/s

} // namespace

GramInverse::GramInverse(const decomposition::DecomposedProblem& problem,
                         const Eigen::SparseMatrix<double>& gram, Form form)
    : comm_(problem.comm), size_(static_cast<int>(gram.rows())), gram_(gram), factor_(std::in_place, gram_),
      shares_(comm_, size_) {
  if (factor_->info() != Eigen::Success)
    throw Error(
        "the rows of G are linearly dependent: some rigid motion of the floating bodies meets no contact");
  if (form == Form::automatic) {
    const bool hasParts = problem.clusters.size() > problem.bodies.size();
    const double ranks = comm_->getSize(), k = size_,
                 ofFactor = 2.0 * static_cast<double>(bytes()), // down and up
        ofRows = sizeof(double) * k * k / ranks + gatheringBytes;
    form = ranks > 1 && hasParts && ofRows < ofFactor ? Form::spread : Form::sparse;
  }
  if (form == Form::spread)
    spread();
}

void GramInverse::spread() {
  gram_ = Eigen::SparseMatrix<double>(gram_.selfadjointView<Eigen::Lower>())
              .middleCols(shares_.first(), shares_.size())
              .eval();
  rows_.resize(size_, shares_.size());
  for (Eigen::Index j = 0; j < rows_.cols(); ++j)
    rows_.col(j) = factor_->solve(Eigen::VectorXd::Unit(size_, shares_.first() + j));
  factor_.reset();
}

void GramInverse::apply(std::span<const double> b, std::span<double> alpha) const {
  const Eigen::Map<const Eigen::VectorXd> given(b.data(), size_);
  if (isSpread()) {
    work_.noalias() = rows_.transpose() * given;
    shares_.gather({work_.data(), static_cast<std::size_t>(work_.size())}, alpha);
    return;
  }
  work_.noalias() = factor_->permutationP() * given;
  factor_->matrixL().solveInPlace(work_);
  factor_->matrixU().solveInPlace(work_);
  Eigen::Map<Eigen::VectorXd>(alpha.data(), size_).noalias() = factor_->permutationPinv() * work_;
}

void GramInverse::multiply(std::span<const double> alpha, std::span<double> b) const {
  const Eigen::Map<const Eigen::VectorXd> given(alpha.data(), size_);
  if (isSpread()) {
    work_.noalias() = gram_.transpose() * given;
    shares_.gather({work_.data(), static_cast<std::size_t>(work_.size())}, b);
  } else {
    Eigen::Map<Eigen::VectorXd>(b.data(), size_).noalias() = gram_.selfadjointView<Eigen::Lower>() * given;
  }
}

std::size_t GramInverse::bytes() const {
  if (isSpread())
    return static_cast<std::size_t>(rows_.size()) * sizeof(double);
  return static_cast<std::size_t>(factor_->matrixL().nestedExpression().nonZeros()) *
         (sizeof(double) + sizeof(int));
}

} // namespace epafi::fetidp
