#include "epafi/direct/DenseSymmetric.hpp"

#include "epafi/base/Errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Teuchos_BLAS.hpp>
#include <Teuchos_LAPACK.hpp>

#include <string>
#include <utility>

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
  int info = 0;
  if (k > 0)
    Teuchos::LAPACK<int, double>().POTRF('L', k, matrix.data(), k, &info);
  if (info != 0)
    throw Error("a condensed matrix of " + std::to_string(k) + " unknowns is not positive definite");
  return inverseFromFactor(std::move(matrix));
}

std::optional<Eigen::MatrixXd> choleskyFactor(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success)
    return std::nullopt;
  return Eigen::MatrixXd(factor.matrixL());
}

SymmetricEigen eigenOf(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() == 0)
    return {Eigen::VectorXd(0), matrix};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success)
    throw Error("the eigenvalues of a matrix of " + std::to_string(matrix.rows()) + " rows were not found");
  return {solver.eigenvalues(), solver.eigenvectors()};
}

} // namespace epafi::direct
