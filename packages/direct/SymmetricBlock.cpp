#include "epafi/direct/SymmetricBlock.hpp"

#include <Teuchos_BLAS.hpp>

#include <algorithm>

// Teuchos has no product with a packed matrix.
extern "C" void dspmv_(const char* uplo, const int* n, const double* alpha, const double* ap, const double* x,
                       const int* incx, const double* beta, double* y, const int* incy);

namespace epafi::direct {
namespace {

/// y = A x or Y = A X of a full matrix, by whichever of BLAS' routines fits the number of columns.
template <class Scalar>
void multiply(int size, int numColumns, const Scalar* a, const Scalar* x, Scalar* y) {
  const Teuchos::BLAS<int, Scalar> blas;
  constexpr Scalar one = 1, zero = 0;
  if (numColumns == 1)
    blas.GEMV(Teuchos::NO_TRANS, size, size, one, a, size, x, 1, zero, y, 1);
  else
    blas.GEMM(Teuchos::NO_TRANS, Teuchos::NO_TRANS, size, numColumns, size, one, a, size, x, size, zero, y,
              size);
}

} // namespace

SymmetricBlock::SymmetricBlock(const Eigen::MatrixXd& matrix, Storage storage)
    : size_(static_cast<int>(matrix.rows())), storage_(storage) {
  const auto numEntries = static_cast<std::size_t>(matrix.size());
  if (storage_ == Storage::full) {
    values_.assign(matrix.data(), matrix.data() + numEntries);
  } else if (storage_ == Storage::single) {
    singleValues_.resize(numEntries);
    std::transform(matrix.data(), matrix.data() + numEntries, singleValues_.begin(),
                   [](double value) { return static_cast<float>(value); });
  } else {
    values_.reserve((numEntries + static_cast<std::size_t>(size_)) / 2);
    for (Eigen::Index column = 0; column < matrix.cols(); ++column)
      for (Eigen::Index row = column; row < matrix.rows(); ++row)
        values_.push_back(matrix(row, column));
  }
}

void SymmetricBlock::apply(const Eigen::MatrixXd& x, Eigen::MatrixXd& y) const {
  const int numColumns = static_cast<int>(x.cols());
  if (size_ == 0 || numColumns == 0)
    return;
  if (storage_ == Storage::full) {
    multiply(size_, numColumns, values_.data(), x.data(), y.data());
  } else if (storage_ == Storage::single) {
    const auto numEntries = static_cast<std::size_t>(x.size());
    singleX_.resize(std::max(singleX_.size(), numEntries));
    singleY_.resize(singleX_.size());
    std::transform(x.data(), x.data() + numEntries, singleX_.begin(),
                   [](double value) { return static_cast<float>(value); });
    multiply(size_, numColumns, singleValues_.data(), singleX_.data(), singleY_.data());
    std::copy_n(singleY_.begin(), numEntries, y.data());
  } else {
    constexpr double one = 1, zero = 0;
    constexpr int step = 1;
    for (Eigen::Index column = 0; column < x.cols(); ++column)
      dspmv_("L", &size_, &one, values_.data(), x.col(column).data(), &step, &zero, y.col(column).data(),
             &step);
  }
}

SymmetricBlock::Storage fasterStorage(int size, int numColumns) {
  constexpr int packedPays = 96; // from here on half the traffic outweighs the slower loop
  return numColumns == 1 && size >= packedPays ? SymmetricBlock::Storage::packed
                                               : SymmetricBlock::Storage::full;
}

} // namespace epafi::direct
