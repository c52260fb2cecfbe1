#include "epafi/direct/SymmetricBlock.hpp"

#include <Teuchos_BLAS.hpp>

#include <algorithm>
#include <cstddef>

// Teuchos has no product with a packed matrix. NOLINTNEXTLINE(readability-identifier-naming): the name is BLAS'
extern "C" void dspmv_(const char* uplo, const int* n, const double* alpha, const double* ap, const double* x,
                       const int* incx, const double* beta, double* y, const int* incy);

namespace epafi::direct {
namespace {

/// From here on a single product is faster with half the matrix (measured with OpenBLAS on one core, the matrix not in
/// the cache: docs/performance.md).
constexpr int packedPays = 96;

/// Columns of one matrix–matrix product, never more, never fewer: OpenBLAS adds in another order where there are many.
constexpr int width = 8;

/// Y = A X of a full matrix. \param padded  work space for the last columns
template <class Scalar>
void multiply(SymmetricBlock::Use use, int size, int numColumns, const Scalar* a, const Scalar* x, Scalar* y,
              std::vector<Scalar>& padded) {
  const Teuchos::BLAS<int, Scalar> blas;
  constexpr Scalar one = 1, zero = 0;
  const auto multiplyColumns = [&](const Scalar* columns, Scalar* image) {
    blas.GEMM(Teuchos::NO_TRANS, Teuchos::NO_TRANS, size, width, size, one, a, size, columns, size, zero,
              image, size);
  };
  std::ptrdiff_t column = 0;
  if (use == SymmetricBlock::Use::alone)
    for (; column < numColumns; ++column)
      blas.GEMV(Teuchos::NO_TRANS, size, size, one, a, size, x + column * size, 1, zero, y + column * size,
                1);
  for (; column + width <= numColumns; column += width)
    multiplyColumns(x + column * size, y + column * size);
  if (column < numColumns) {
    const std::ptrdiff_t numRest = (numColumns - column) * size, numPadded = std::ptrdiff_t{width} * size;
    padded.resize(static_cast<std::size_t>(2 * numPadded));
    std::fill(std::copy_n(x + column * size, numRest, padded.begin()), padded.begin() + numPadded, zero);
    multiplyColumns(padded.data(), padded.data() + numPadded);
    std::copy_n(padded.begin() + numPadded, numRest, y + column * size);
  }
}

} // namespace

SymmetricBlock::SymmetricBlock(const Eigen::MatrixXd& matrix, Use use, Precision precision)
    : size_(static_cast<int>(matrix.rows())), use_(use),
      storage_(precision == Precision::single             ? Storage::single
               : use == Use::alone && size_ >= packedPays ? Storage::packed
                                                          : Storage::full) {
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
      values_.insert(values_.end(), &matrix(column, column), matrix.data() + (column + 1) * matrix.rows());
  }
}

void SymmetricBlock::apply(const Eigen::MatrixXd& x, Eigen::MatrixXd& y) const {
  const int numColumns = static_cast<int>(x.cols());
  if (size_ == 0 || numColumns == 0)
    return;
  if (storage_ == Storage::full) {
    multiply(use_, size_, numColumns, values_.data(), x.data(), y.data(), padded_);
  } else if (storage_ == Storage::single) {
    const auto numEntries = static_cast<std::size_t>(x.size());
    singleX_.resize(std::max(singleX_.size(), numEntries));
    singleY_.resize(singleX_.size());
    std::transform(x.data(), x.data() + numEntries, singleX_.begin(),
                   [](double value) { return static_cast<float>(value); });
    multiply(use_, size_, numColumns, singleValues_.data(), singleX_.data(), singleY_.data(), singlePadded_);
    std::copy_n(singleY_.begin(), numEntries, y.data());
  } else {
    constexpr double one = 1, zero = 0;
    constexpr int step = 1;
    for (Eigen::Index column = 0; column < x.cols(); ++column)
      dspmv_("L", &size_, &one, values_.data(), x.col(column).data(), &step, &zero, y.col(column).data(),
             &step);
  }
}

} // namespace epafi::direct
