#pragma once

/// G̃ZG̃ᵀ, k × k and sparse: Z = 1 on a face, where multipliers may move, and 0 off it. A row of B touches few clusters, and so a cluster of
/// subdomains meets its neighbours alone.

#include "epafi/fetidp/KernelConstraint.hpp"

#include <Eigen/SparseCore>

#include <cstdint>
#include <functional>
#include <vector>

namespace epafi::fetidp {

/// The same on every rank, to the last digit.
class KernelGram {
public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// \param entries  see kernelConstraint
  /// Collective.
  KernelGram(const decomposition::DecomposedProblem& problem, const std::vector<KernelEntry>& entries);

  [[nodiscard]] int size() const { return size_; } ///< k
  /// G̃G̃ᵀ, lower triangle. Collective.
  [[nodiscard]] Matrix whole() const;
  /// G̃ZG̃ᵀ, lower triangle, the same pattern as the whole. \param face  1 where multipliers may move, else 0; rows of gluing and ties always may
  /// One message of the number of pairs of modes that contact joins. Collective.
  [[nodiscard]] Matrix onFace(const Vector& face) const;

private:
  /// What one row adds to one entry.
  struct Term {
    std::size_t pair;
    int row; ///< local
    double value;
  };
  using Pairs = std::vector<std::int64_t>; ///< places in the matrix, column by column
  [[nodiscard]] Matrix matrixOf(const std::vector<AccurateSum>& contact) const;

  RCP<const Comm> comm_;
  int size_;
  Pairs fixed_, contact_;            ///< of rows without bounds, and of contact
  std::vector<AccurateSum> ofFixed_; ///< their sums over the ranks
  std::vector<Term> terms_;          ///< of contact, this rank's
};

} // namespace epafi::fetidp
