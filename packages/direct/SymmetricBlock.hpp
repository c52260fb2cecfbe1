#pragma once

/// A dense symmetric matrix that is multiplied often: the condensed block of a subdomain. How it is stored
/// follows from what is faster at its size.

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace epafi::direct {

class SymmetricBlock {
public:
  /// Whether products are with one vector at a time, or with several. The columns of a product do not depend
  /// on how many there are.
  enum class Use { alone, shared };
  /// In which the numbers are kept and multiplied; single is for preconditioners alone.
  enum class Precision { full, single };

  SymmetricBlock() = default;
  /// \param matrix  k × k, both triangles. Stored are k(k + 1)/2 numbers for a large matrix used alone, else
  /// k².
  SymmetricBlock(const Eigen::MatrixXd& matrix, Use use, Precision precision = Precision::full);

  [[nodiscard]] int size() const { return size_; }                 ///< k
  [[nodiscard]] Precision precision() const { return precision_; } ///< as it was asked for
  /// A, both triangles, as it is kept.
  [[nodiscard]] Eigen::MatrixXd matrix() const;
  /// Y = A X; both k × m, m ≥ 0, column-major without gaps. Not collective. Y may not overlap X.
  void apply(const Eigen::MatrixXd& x, Eigen::MatrixXd& y) const;
  /// Bytes that one product reads of the matrix; also what it takes in memory.
  [[nodiscard]] std::size_t bytes() const {
    return values_.size() * sizeof(double) + singleValues_.size() * sizeof(float);
  }

private:
  template <class Scalar>
  void applyStored(const std::vector<Scalar>& values, int numColumns, const Scalar* x, Scalar* y,
                   std::vector<Scalar>& padded) const;

  int size_ = 0;
  Use use_ = Use::alone;
  bool isPacked_ = false;
  Precision precision_ = Precision::full;
  std::vector<double> values_;
  std::vector<float> singleValues_;
  mutable std::vector<float> singleX_, singleY_, singlePadded_; ///< work
  mutable std::vector<double> padded_;                          ///< work
};

} // namespace epafi::direct
