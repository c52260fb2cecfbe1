#pragma once

/// The last k columns of a factor by CHOLMOD: C, lower triangular, with S = C Cᵀ for the Schur complement S
/// of the k unknowns that are eliminated last. S and S⁻¹ are applied where the factor lies, without the rest
/// of it.

#include <Eigen/Core>

#include <cstddef>
#include <vector>

struct cholmod_factor_struct; // NOLINT(readability-identifier-naming): a cholmod_factor

namespace epafi::direct {

/// Refers to the factor, which must stay as it is. Unknowns are counted from the first of the k, in the
/// factor's order.
class LastBlock {
public:
  /// \param factor  L Lᵀ, simplicial or supernodal; 0 ≤ k ≤ its size
  LastBlock(const cholmod_factor_struct& factor, int k);

  /// C, k × k.
  [[nodiscard]] Eigen::MatrixXd dense() const;
  /// x = S⁻¹ x; k entries. Two passes over C.
  void solve(double* x) const;
  /// x = S x, likewise.
  void multiply(double* x) const;
  /// What is read of C in one pass.
  [[nodiscard]] std::size_t numEntries() const;

private:
  /// Columns of C with the same rows: a triangle, and numBelow dense rows under it.
  struct Panel {
    int first, width;     ///< of its columns
    const int* below;     ///< rows under the triangle, counted in the whole factor
    int numBelow;         ///< how many
    const double* values; ///< column by column
    int stride;           ///< from a column to the next
  };
  void addPanel(const int* rows, int numRows, int width, const double* values);
  static void solveTriangle(const char* transposed, const Panel& panel, double* x);
  static void multiplyTriangle(const char* transposed, const Panel& panel, double* x);
  void addBelow(const Panel& panel, double factor, double* x) const;
  void addFromBelow(const Panel& panel, double factor, double* x) const;

  int offset_; ///< unknowns before the k
  std::vector<Panel> panels_;
  mutable std::vector<double> below_; ///< work
};

} // namespace epafi::direct
