#include "epafi/direct/DenseSymmetric.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_BLAS.hpp>
#include <Teuchos_LAPACK.hpp>

namespace epafi::direct {
namespace {

void mirrorLower(Eigen::MatrixXd& matrix) {
  matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
}

} // namespace

Eigen::MatrixXd productOfFactor(const Eigen::MatrixXd& lower) {
  Eigen::MatrixXd result(lower.rows(), lower.cols());
  const int k = static_cast<int>(lower.rows());
  if (k > 0)
    Teuchos::BLAS<int, double>().SYRK(Teuchos::LOWER_TRI, Teuchos::NO_TRANS, k, k, 1.0, lower.data(), k, 0.0,
                                      result.data(), k);
  mirrorLower(result);
  return result;
}

Eigen::MatrixXd inverseFromFactor(Eigen::MatrixXd lower) {
  const int k = static_cast<int>(lower.rows());
  if (k == 0)
    return lower;
  int info = 0;
  Teuchos::LAPACK<int, double>().POTRI('L', k, lower.data(), k, &info);
  if (info != 0)
    throw Error("a condensed matrix of " + std::to_string(k) + " unknowns is singular");
  mirrorLower(lower);
  return lower;
}

Eigen::MatrixXd inverseOfSpd(Eigen::MatrixXd matrix) {
  const int k = static_cast<int>(matrix.rows());
  if (k == 0)
    return matrix;
  int info = 0;
  Teuchos::LAPACK<int, double>().POTRF('L', k, matrix.data(), k, &info);
  if (info != 0)
    throw Error("a condensed matrix of " + std::to_string(k) + " unknowns is not positive definite");
  return inverseFromFactor(std::move(matrix));
}

} // namespace epafi::direct
