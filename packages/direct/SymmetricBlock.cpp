#include "epafi/direct/SymmetricBlock.hpp"

#include <Teuchos_BLAS.hpp>

#include <algorithm>
#include <cstddef>

// Teuchos has no product with a packed matrix; the names are BLAS'.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" void dspmv_(const char* uplo, const int* n, const double* alpha, const double* ap, const double* x,
                       const int* incx, const double* beta, double* y, const int* incy);
extern "C" void sspmv_(const char* uplo, const int* n, const float* alpha, const float* ap, const float* x,
                       const int* incx, const float* beta, float* y, const int* incy);
// NOLINTEND(readability-identifier-naming)

namespace epafi::direct {
namespace {

/// From here on a single product is as fast or faster with half the matrix (measured with OpenBLAS on one
/// core, the matrix not in the cache: docs/performance.md).
constexpr int packedPays = 48;

/// Columns of one matrix–matrix product, never more, never fewer: OpenBLAS adds in another order where there
/// are many.
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
    padded.resize(2 * numPadded);
    std::fill(std::copy_n(x + column * size, numRest, padded.begin()), padded.begin() + numPadded, zero);
    multiplyColumns(padded.data(), padded.data() + numPadded);
    std::copy_n(padded.begin() + numPadded, numRest, y + column * size);
  }
}

void multiplyPacked(int size, const double* a, const double* x, double* y) {
  constexpr double one = 1, zero = 0;
  constexpr int step = 1;
  dspmv_("L", &size, &one, a, x, &step, &zero, y, &step);
}

void multiplyPacked(int size, const float* a, const float* x, float* y) {
  constexpr float one = 1, zero = 0;
  constexpr int step = 1;
  sspmv_("L", &size, &one, a, x, &step, &zero, y, &step);
}

/// The lower triangle column by column, or all.
template <class Scalar>
std::vector<Scalar> stored(const Eigen::MatrixXd& matrix, bool isPacked) {
  std::vector<Scalar> values;
  values.reserve(isPacked ? (matrix.size() + matrix.rows()) / 2 : matrix.size());
  for (Eigen::Index column = 0; column < matrix.cols(); ++column)
    for (Eigen::Index row = isPacked ? column : 0; row < matrix.rows(); ++row)
      values.push_back(static_cast<Scalar>(matrix(row, column)));
  return values;
}

/// The matrix of which `stored` made the values.
template <class Scalar>
Eigen::MatrixXd restored(const std::vector<Scalar>& values, Eigen::Index size, bool isPacked) {
  Eigen::MatrixXd matrix(size, size);
  auto value = values.begin();
  for (Eigen::Index column = 0; column < size; ++column)
    for (Eigen::Index row = isPacked ? column : 0; row < size; ++row)
      matrix(row, column) = matrix(column, row) = *value++;
  return matrix;
}

} // namespace

SymmetricBlock::SymmetricBlock(const Eigen::MatrixXd& matrix, Use use, Precision precision)
    : size_(static_cast<int>(matrix.rows())), use_(use), isPacked_(use == Use::alone && size_ >= packedPays),
      precision_(precision) {
  if (precision == Precision::single)
    singleValues_ = stored<float>(matrix, isPacked_);
  else
    values_ = stored<double>(matrix, isPacked_);
}

Eigen::MatrixXd SymmetricBlock::matrix() const {
  return precision_ == Precision::single ? restored(singleValues_, size_, isPacked_)
                                         : restored(values_, size_, isPacked_);
}

template <class Scalar>
void SymmetricBlock::applyStored(const std::vector<Scalar>& values, int numColumns, const Scalar* x,
                                 Scalar* y, std::vector<Scalar>& padded) const {
  if (!isPacked_) {
    multiply(use_, size_, numColumns, values.data(), x, y, padded);
    return;
  }
  for (std::ptrdiff_t column = 0; column < numColumns; ++column) {
    const Scalar* given = x + column * size_;
    if (std::all_of(given, given + size_, [](Scalar value) { return value == 0; }))
      std::fill_n(y + column * size_, size_, Scalar{0}); // constraints touch few subdomains
    else
      multiplyPacked(size_, values.data(), given, y + column * size_);
  }
}

void SymmetricBlock::apply(const Eigen::MatrixXd& x, Eigen::MatrixXd& y) const {
  const int numColumns = static_cast<int>(x.cols());
  if (size_ == 0 || numColumns == 0)
    return;
  if (precision_ == Precision::full) {
    applyStored(values_, numColumns, x.data(), y.data(), padded_);
    return;
  }
  const std::size_t numEntries = x.size();
  singleX_.resize(std::max(singleX_.size(), numEntries));
  singleY_.resize(singleX_.size());
  std::transform(x.data(), x.data() + numEntries, singleX_.begin(),
                 [](double value) { return static_cast<float>(value); });
  applyStored(singleValues_, numColumns, singleX_.data(), singleY_.data(), singlePadded_);
  std::copy_n(singleY_.begin(), numEntries, y.data());
}

} // namespace epafi::direct
