#pragma once

/// A dense symmetric matrix that is multiplied often: the condensed block of a subdomain. How it is stored follows from
/// what is faster at its size.

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace epafi::direct {

class SymmetricBlock {
public:
  enum class Storage {
    full, ///< k × k: one product reads k² numbers, many at once run at the speed of matrix–matrix products
    packed, ///< k(k + 1)/2 numbers, half the memory and half the traffic of a single product
    single  ///< k × k in single precision: for preconditioners alone
  };

  SymmetricBlock() = default;
  /// \param matrix  k × k, both triangles
  SymmetricBlock(const Eigen::MatrixXd& matrix, Storage storage);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] Storage storage() const { return storage_; }
  /// Y = A X; both k × m, m ≥ 0, column-major without gaps. Not collective. Y may not overlap X.
  void apply(const Eigen::MatrixXd& x, Eigen::MatrixXd& y) const;
  /// Bytes that one product reads of the matrix; also what it takes in memory.
  [[nodiscard]] std::size_t bytes() const {
    return values_.size() * sizeof(double) + singleValues_.size() * sizeof(float);
  }

private:
  int size_ = 0;
  Storage storage_ = Storage::full;
  std::vector<double> values_;
  std::vector<float> singleValues_;
  mutable std::vector<float> singleX_, singleY_; ///< work
};

/// The faster storage for products with `numColumns` vectors at once (measured with OpenBLAS on one core, the matrix not
/// in the cache: see docs/performance.md).
SymmetricBlock::Storage fasterStorage(int size, int numColumns);

} // namespace epafi::direct
