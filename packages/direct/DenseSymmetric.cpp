#include "epafi/direct/DenseSymmetric.hpp"

#include "epafi/base/Errors.hpp"

#include <Eigen/Cholesky>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// LAPACK's eigenvalues by relatively robust representations, which Teuchos does not wrap; the last three are
/// lengths of texts.
extern "C" void dsyevr_( // NOLINT(readability-identifier-naming): LAPACK's name
    const char* jobz, const char* range, const char* uplo, const int* n, double* a, const int* lda,
    const double* vl, const double* vu, const int* il, const int* iu, const double* abstol, int* m, double* w,
    double* z, const int* ldz, int* isuppz, double* work, const int* lwork, int* iwork, const int* liwork,
    int* info, std::size_t, std::size_t, std::size_t);
/// U Uᵀ of an upper triangle, in its place.
extern "C" void dlauum_( // NOLINT(readability-identifier-naming)
    const char* uplo, const int* n, double* a, const int* lda, int* info, std::size_t);

namespace epafi::direct {
namespace {

void mirrorLower(Eigen::MatrixXd& matrix) {
  matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
}

} // namespace

Eigen::MatrixXd productOfFactor(Eigen::MatrixXd lower) {
  const int k = static_cast<int>(lower.rows());
  if (k == 0)
    return lower;
  double *const begin = lower.data(), *const end = begin + lower.size();
  int info = 0;
  std::reverse(
      begin,
      end); // with the last row and column first C is an upper triangle: a third of a general product's work
  dlauum_("U", &k, begin, &k, &info, 1);
  std::reverse(begin, end);
  mirrorLower(lower);
  return lower;
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

Eigen::MatrixXd solvedSymmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.ldlt().solve(b);
}

SymmetricEigen eigenOf(Eigen::MatrixXd matrix) {
  const int n = static_cast<int>(matrix.rows());
  if (n == 0)
    return {Eigen::VectorXd(0), matrix};
  if (!matrix.triangularView<Eigen::Lower>().toDenseMatrix().allFinite())
    throw Error("the eigenvalues of a matrix of " + std::to_string(n) + " rows were not found");
  const double unused = 0, exact = 0;
  int found = 0, info = 0, first = 0;
  SymmetricEigen eigen{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  std::vector<int> support(2 * static_cast<std::size_t>(n)), integers(1);
  std::vector<double> work(1);
  int numWork = -1, numIntegers = -1; // asks how many there are to be
  for (int pass = 0; pass < 2; ++pass) {
    dsyevr_("V", "A", "L", &n, matrix.data(), &n, &unused, &unused, &first, &first, &exact, &found,
            eigen.values.data(), eigen.vectors.data(), &n, support.data(), work.data(), &numWork,
            integers.data(), &numIntegers, &info, 1, 1, 1);
    if (info != 0)
      throw Error("the eigenvalues of a matrix of " + std::to_string(n) + " rows were not found");
    if (pass == 0) {
      numWork = static_cast<int>(work[0]);
      numIntegers = integers[0];
      work.resize(numWork);
      integers.resize(numIntegers);
    }
  }
  return eigen;
}

} // namespace epafi::direct
