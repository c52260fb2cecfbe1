#pragma once

/// Small dense symmetric matrices: what takes long to compile stands in one unit.

#include <Eigen/Core>

#include <optional>

namespace epafi::direct {

/// C Cᵀ of a lower triangular C, k × k; both triangles of the result are equal to the last digit.
Eigen::MatrixXd productOfFactor(Eigen::MatrixXd lower);
/// (C Cᵀ)⁻¹, likewise. \throws Error if an entry of C's diagonal is 0.
Eigen::MatrixXd inverseFromFactor(Eigen::MatrixXd lower);
/// A⁻¹ of a symmetric positive definite A, of which the lower triangle is read. \throws Error if A is not.
Eigen::MatrixXd inverseOfSpd(Eigen::MatrixXd matrix);
/// The lower triangular C of A = CCᵀ, likewise; nothing if A is not positive definite.
std::optional<Eigen::MatrixXd> choleskyFactor(const Eigen::MatrixXd& matrix);

/// A⁻¹B of a symmetric A, of which the lower triangle is read, and which may be semidefinite.
Eigen::MatrixXd solvedSymmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Eigenvalues and eigenvectors.
struct SymmetricEigen {
  Eigen::VectorXd values;  ///< ascending
  Eigen::MatrixXd vectors; ///< orthonormal columns, in the same order

  /// Number of the values up to a threshold.
  [[nodiscard]] Eigen::Index numUpTo(double threshold) const { return (values.array() <= threshold).count(); }
};

/// Of a symmetric matrix, of which the lower triangle is read. \throws Error if the iteration fails.
SymmetricEigen eigenOf(Eigen::MatrixXd matrix);

} // namespace epafi::direct
