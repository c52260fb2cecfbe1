#include "epafi/fetidp/DualColumnSpace.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>

namespace epafi::fetidp {
namespace {

constexpr int batch = 32; ///< products with A at once

} // namespace

DualColumnSpace::DualColumnSpace(const Operator& a, const OverratedColumns& columns, const Import& plan,
                                 const Operator* m)
    : comm_(plan.getSourceMap()->getComm()), numColumns_(columns.number),
      image_(static_cast<Eigen::Index>(numLocal(*plan.getSourceMap())), numColumns_),
      sums_(static_cast<std::size_t>(numColumns_)), coefficients_(numColumns_) {
  for (int first = 0; first < numColumns_; first += batch)
    multiply(a, m, columns.entries, plan, first, std::min(batch, numColumns_ - first));
  factorize();
}

/// Columns first … first + count − 1 of U, from the ranks that made them to the owners of the rows, and of AU.
void DualColumnSpace::multiply(const Operator& a, const Operator* m,
                               const std::vector<OverratedColumns::Entry>& entries, const Import& plan,
                               int first, int count) {
  MultiVector ghost(plan.getTargetMap(), static_cast<std::size_t>(count));
  for (const OverratedColumns::Entry& entry : entries)
    if (entry.column >= first && entry.column < first + count)
      ghost.replaceLocalValue(entry.row, static_cast<std::size_t>(entry.column - first), entry.value);
  MultiVector u(plan.getSourceMap(), static_cast<std::size_t>(count)),
      au(plan.getSourceMap(), static_cast<std::size_t>(count));
  u.doExport(ghost, plan, Tpetra::ADD);
  if (m != nullptr) {
    au.assign(u);
    m->apply(au, u);
  }
  a.apply(u, au);
  for (int column = 0; column < count; ++column) {
    const auto values = u.getData(static_cast<std::size_t>(column)),
               products = au.getData(static_cast<std::size_t>(column));
    for (Teuchos_Ordinal row = 0; row < values.size(); ++row) {
      image_(row, first + column) = products[row];
      if (values[row] != 0)
        columns_.push_back({static_cast<int>(row), first + column, values[row]});
    }
  }
}

/// UᵀAU, column after column, and its Cholesky factor. Collective.
void DualColumnSpace::factorize() {
  Eigen::MatrixXd matrix(numColumns_, numColumns_);
  for (Eigen::Index column = 0; column < numColumns_; ++column) {
    std::fill(sums_.begin(), sums_.end(), AccurateSum());
    for (const Entry& entry : columns_)
      sums_[static_cast<std::size_t>(entry.column)].add(entry.value * image_(entry.row, column));
    sumOverRanks(*comm_, sums_);
    for (Eigen::Index row = 0; row < numColumns_; ++row)
      matrix(row, column) = sums_[static_cast<std::size_t>(row)].value();
  }
  scale_ = matrix.diagonal().cwiseMax(0).cwiseSqrt().cwiseInverse();
  factor_.compute(scale_.asDiagonal() * (0.5 * (matrix + matrix.transpose())) * scale_.asDiagonal());
  if (!scale_.allFinite() || factor_.info() != Eigen::Success) // the same on all ranks
    throw Error("the adaptive constraints are not independent: round-off in the subdomain solves has grown "
                "too large; "
                "avoid very flat elements and very large jumps of stiffness, or set Adaptive Constraints/Use "
                "to 'no'");
}

/// (UᵀAU)⁻¹ times the sums over the ranks.
const Eigen::VectorXd& DualColumnSpace::solve() const {
  sumOverRanks(*comm_, sums_);
  for (Eigen::Index k = 0; k < numColumns_; ++k)
    coefficients_[k] = sums_[static_cast<std::size_t>(k)].value() * scale_[k];
  factor_.solveInPlace(coefficients_);
  coefficients_.array() *= scale_.array();
  return coefficients_;
}

const Eigen::VectorXd& DualColumnSpace::coefficients(const Vector& d) const {
  std::fill(sums_.begin(), sums_.end(), AccurateSum());
  const auto values = qp::localData(d);
  for (const Entry& entry : columns_)
    sums_[static_cast<std::size_t>(entry.column)].add(entry.value *
                                                      values[static_cast<std::size_t>(entry.row)]);
  return solve();
}

const Eigen::VectorXd& DualColumnSpace::imageCoefficients(const Vector& x) const {
  std::fill(sums_.begin(), sums_.end(), AccurateSum());
  const auto values = qp::localData(x);
  for (Eigen::Index k = 0; k < numColumns_; ++k)
    for (std::size_t row = 0; row < values.size(); ++row)
      sums_[static_cast<std::size_t>(k)].add(image_(static_cast<Eigen::Index>(row), k) * values[row]);
  return solve();
}

void DualColumnSpace::add(const Eigen::VectorXd& c, double factor, Vector& x) const {
  const auto values = qp::localDataNonConst(x);
  for (const Entry& entry : columns_)
    values[static_cast<std::size_t>(entry.row)] += factor * entry.value * c[entry.column];
}

/// Entry by entry in the same order whatever the number of rows, so that ranks do not matter.
void DualColumnSpace::subtractImage(const Eigen::VectorXd& c, Vector& y) const {
  const auto values = qp::localDataNonConst(y);
  Eigen::Index k = 0;
  for (; k + 4 <= numColumns_; k += 4) {
    const double *a0 = image_.col(k).data(), *a1 = image_.col(k + 1).data(), *a2 = image_.col(k + 2).data(),
                 *a3 = image_.col(k + 3).data();
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] -= (a0[i] * c[k] + a1[i] * c[k + 1]) + (a2[i] * c[k + 2] + a3[i] * c[k + 3]);
  }
  for (; k < numColumns_; ++k)
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] -= image_(static_cast<Eigen::Index>(i), k) * c[k];
}

std::size_t DualColumnSpace::bytes() const {
  return static_cast<std::size_t>(image_.size()) * sizeof(double) + columns_.size() * sizeof(Entry);
}

} // namespace epafi::fetidp
