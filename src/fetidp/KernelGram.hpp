#pragma once

/// N = G̃G̃ᵀ, k × k and sparse: a row of B touches few clusters, and so a cluster of subdomains meets its neighbours alone.

#include "epafi/fetidp/KernelConstraint.hpp"

#include <Eigen/SparseCore>

#include <cstdint>
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
  /// N, lower triangle. Collective.
  [[nodiscard]] Matrix whole() const;
  /// Modes that rows of contact touch, ascending: n of them.
  [[nodiscard]] const std::vector<int>& contactModes() const { return contactModes_; }
  /// Σ gᵢgᵢᵀ over the rows of contact off a face, gᵢ a column of G̃ at the modes of contact, n × n: what N lacks there.
  /// \param face  1 where multipliers may move, else 0; rows of gluing and ties always may
  /// One message of the number of pairs of modes that contact joins. Collective.
  [[nodiscard]] Eigen::MatrixXd offFace(const Vector& face) const;

private:
  /// What one row adds to one entry.
  struct Term {
    std::size_t pair;
    int row; ///< local
    double value;
  };
  using Pairs = std::vector<std::int64_t>; ///< places in the matrix, column by column
  template <class Counts>
  [[nodiscard]] std::vector<AccurateSum> sumsOf(const Counts& counts) const;

  RCP<const Comm> comm_;
  int size_;
  Pairs fixed_, contact_;            ///< of rows without bounds, and of contact
  std::vector<AccurateSum> ofFixed_; ///< their sums over the ranks
  std::vector<Term> terms_;          ///< of contact, this rank's
  std::vector<int> contactModes_;
};

} // namespace epafi::fetidp
