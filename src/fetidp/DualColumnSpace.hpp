#pragma once

/// The space of a few columns U of multipliers beside an operator A on the multipliers: what
/// deflation and coarse corrections compute with.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/fetidp/OverratedColumns.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

namespace epafi::fetidp {

/// n_λ × n_U. Memory: AU, n_λ n_U numbers shared by the ranks, and n_U² on every rank.
class DualColumnSpace {
public:
  /// Costs n_U products with A, 32 at once.
  /// \param a     A, symmetric positive semidefinite on plan's source map
  /// \param plan  from multiplierMap to multiplierGhostMap
  /// \param m     U is M times the columns; null: it is the columns themselves
  /// \throws Error if UᵀAU is not positive definite. Collective.
  DualColumnSpace(const Operator& a, const OverratedColumns& columns, const Import& plan,
                  const Operator* m = nullptr);

  /// n_U.
  [[nodiscard]] int size() const { return numColumns_; }
  /// (UᵀAU)⁻¹Uᵀd, valid until the next call of this or the next function. One message of n_U numbers. Collective.
  const Eigen::VectorXd& coefficients(const Vector& d) const;
  /// (UᵀAU)⁻¹UᵀAx, likewise.
  const Eigen::VectorXd& imageCoefficients(const Vector& x) const;
  /// x += factor · U c. Not collective.
  void add(const Eigen::VectorXd& c, double factor, Vector& x) const;
  /// y −= AU c. Not collective.
  void subtractImage(const Eigen::VectorXd& c, Vector& y) const;
  /// Of this rank's part of U and AU.
  [[nodiscard]] std::size_t bytes() const;

private:
  struct Entry {
    int row, column; ///< row: local index in the map
    double value;
  };
  void multiply(const Operator& a, const Operator* m, const std::vector<OverratedColumns::Entry>& entries,
                const Import& plan, int first, int count);
  void factorize();
  const Eigen::VectorXd& solve() const;

  RCP<const Comm> comm_;
  int numColumns_;
  std::vector<Entry> columns_;            ///< U, this rank's rows, column after column
  Eigen::MatrixXd image_;                 ///< AU, this rank's rows
  Eigen::VectorXd scale_;                 ///< D = diag(UᵀAU)^(−1/2)
  Eigen::LLT<Eigen::MatrixXd> factor_;    ///< of D UᵀAU D, on every rank
  mutable std::vector<AccurateSum> sums_; ///< work, n_U
  mutable Eigen::VectorXd coefficients_;  ///< likewise
};

} // namespace epafi::fetidp
