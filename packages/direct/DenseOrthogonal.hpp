#pragma once

/// Orthogonal factorisations of small dense matrices: what takes long to compile stands in one unit.

#include <Eigen/Core>

#include <vector>

namespace epafi::direct {

/// Orthonormal columns that span those of a matrix of full rank, m × n, m ≥ n.
Eigen::MatrixXd orthonormalBasis(const Eigen::MatrixXd& columns);
/// Orthonormal columns that span what those of a matrix of full rank are orthogonal to, m × (m − n).
Eigen::MatrixXd orthogonalComplement(const Eigen::MatrixXd& columns);
/// R of A = QR, min(m, n) × n, of an m × n matrix.
Eigen::MatrixXd triangularFactor(const Eigen::MatrixXd& matrix);

/// Columns of a matrix in an order in which each is as independent as can be of those before it.
struct PivotedColumns {
  std::vector<Eigen::Index> order;
  Eigen::Index rank = 0; ///< number of the first ones that are independent
  Eigen::MatrixXd basis; ///< orthonormal columns that span these
};
/// \param threshold  what is less than this share of the longest column counts as dependent; 0: round-off
PivotedColumns pivotedColumns(const Eigen::MatrixXd& columns, double threshold = 0);

/// The x with the least ‖Ax − b‖, each column of b for itself; entries of dependent columns are 0.
Eigen::MatrixXd leastSquares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Singular values, descending, and the vectors V, n × n, of an m × n matrix.
struct RightSingular {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
RightSingular rightSingularOf(const Eigen::MatrixXd& matrix);

} // namespace epafi::direct
