#include "epafi/direct/DenseOrthogonal.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>

namespace epafi::direct {
namespace {

/// Columns [begin, end) of Q.
template <class Factor>
Eigen::MatrixXd columnsOfQ(const Factor& qr, Eigen::Index begin, Eigen::Index end) {
  Eigen::MatrixXd q = Eigen::MatrixXd::Identity(qr.rows(), end).rightCols(end - begin);
  q.applyOnTheLeft(qr.householderQ());
  return q;
}

} // namespace

Eigen::MatrixXd orthonormalBasis(const Eigen::MatrixXd& columns) {
  return columnsOfQ(Eigen::HouseholderQR<Eigen::MatrixXd>(columns), 0, columns.cols());
}

Eigen::MatrixXd orthogonalComplement(const Eigen::MatrixXd& columns) {
  return columnsOfQ(Eigen::HouseholderQR<Eigen::MatrixXd>(columns), columns.cols(), columns.rows());
}

Eigen::MatrixXd triangularFactor(const Eigen::MatrixXd& matrix) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix);
  return qr.matrixQR().topRows(std::min(matrix.rows(), matrix.cols())).triangularView<Eigen::Upper>();
}

PivotedColumns pivotedColumns(const Eigen::MatrixXd& columns, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns.rows(), columns.cols());
  if (threshold > 0)
    qr.setThreshold(threshold);
  qr.compute(columns);
  const auto& order = qr.colsPermutation().indices();
  return {{order.begin(), order.end()}, qr.rank(), columnsOfQ(qr, 0, qr.rank())};
}

Eigen::MatrixXd leastSquares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

RightSingular rightSingularOf(const Eigen::MatrixXd& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

} // namespace epafi::direct
