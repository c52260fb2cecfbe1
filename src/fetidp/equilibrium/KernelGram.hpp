#pragma once

/// N = G̃G̃ᵀ, k × k and sparse: a row of B touches few clusters, and so a cluster of subdomains meets its
/// neighbours alone.

#include "epafi/base/RankGroups.hpp"
#include "epafi/fetidp/equilibrium/KernelConstraint.hpp"
#include "epafi/qp/constraints/Face.hpp"

#include <Eigen/SparseCore>

#include <cstdint>
#include <vector>

namespace epafi::fetidp {

/// N, lower triangle, the same to the last digit on all ranks that lead a group; without entries on the
/// others.
/// \param entries  see kernelConstraint
/// Collective.
Eigen::SparseMatrix<double> kernelGram(const decomposition::DecomposedProblem& problem,
                                       const std::vector<KernelEntry>& entries, const RankGroups& groups);

/// What rows of contact and friction add to N, at the n modes that they touch.
class ContactGram {
public:
  /// Collective.
  ContactGram(const decomposition::DecomposedProblem& problem, const std::vector<KernelEntry>& entries);

  [[nodiscard]] const std::vector<int>& modes() const { return modes_; } ///< ascending
  /// Which of these modes hold the bodies: no motion of a body leaves all its *anchors* at rest. Indices into
  /// modes().
  [[nodiscard]] const std::vector<int>& anchors() const { return anchors_; }
  /// Σ gᵢgᵢᵀ over the rows of contact and friction off a face, gᵢ a column of G̃ at these modes, n × n: what
  /// N lacks there; along a tangent the row across it is off. The same on every rank.
  /// \param face  rows of gluing and ties are always on it
  /// One message of the number of pairs of modes that contact joins. Collective.
  [[nodiscard]] Eigen::MatrixXd offFace(const qp::Face& face) const;

private:
  /// What one row adds to one entry.
  struct Term {
    std::size_t pair;
    int row; ///< local
    double value;
  };

  RCP<const Comm> comm_;
  std::vector<int> modes_, anchors_;
  std::vector<std::int64_t> pairs_; ///< places in the n × n matrix, column by column, of the lower triangle
  std::vector<Term> terms_;         ///< this rank's
  std::vector<Term> mixed_; ///< gᵢgₖᵀ + gₖgᵢᵀ of the two tangents of a node, by the row of the first
};

} // namespace epafi::fetidp
