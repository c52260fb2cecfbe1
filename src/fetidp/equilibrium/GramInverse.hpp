#pragma once

/// N⁻¹ of N = G̃G̃ᵀ (KernelGram.hpp), the coarse problem of P, for small vectors that every rank has. In one
/// of two forms:
///   sparse a Cholesky factor on every rank, which each solves with: nothing to send, but of the whole
///   problem's size;
///   spread a share of the rows of N⁻¹ on each rank, dense: 8k²/P bytes on P ranks, k/P dot products and a
///   gathering of k numbers.
/// Many clusters on few ranks are cheaper sparse; a few on each of many ranks, spread. Rows are made by √P
/// ranks, or one of sixteen if these are more, which alone have N and its factor for that time, each for its
/// neighbours.

#include "epafi/base/EvenShares.hpp"
#include "epafi/base/RankGroups.hpp"
#include "epafi/fetidp/equilibrium/KernelConstraint.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace epafi::fetidp {

class GramInverse {
public:
  enum class Form { automatic, sparse, spread };
  /// \param entries  see kernelConstraint
  /// \param form  automatic: what takes least, by the bytes that a product reads and its message; sparse on
  /// one rank, and where all clusters are whole bodies, whose numbers are to be the same to the last digit on
  /// any number of ranks
  /// Collective. \throws Error, the same on all ranks, if N is not positive definite: then G̃ has not full
  /// row rank.
  GramInverse(const decomposition::DecomposedProblem& problem, const std::vector<KernelEntry>& entries,
              Form form = Form::automatic);

  [[nodiscard]] int size() const { return size_; }                    ///< k
  [[nodiscard]] const RCP<const Comm>& comm() const { return comm_; } ///< all ranks
  /// α = N⁻¹b. Spread: one message. Collective.
  void apply(std::span<const double> b, std::span<double> alpha) const;
  /// b = Nα. Spread: one message. Collective.
  void multiply(std::span<const double> alpha, std::span<double> b) const;
  [[nodiscard]] bool isSpread() const { return !factor_; }
  [[nodiscard]] std::size_t bytes() const; ///< of this rank

private:
  [[nodiscard]] std::size_t factorBytes() const;
  [[nodiscard]] bool rowsTakeLess() const;
  void spread(const RankGroups& groups);
  void share(const RankGroups& groups);

  RCP<const Comm> comm_;
  int size_;
  Eigen::SparseMatrix<double> gram_; ///< N, lower triangle; spread: this rank's columns
  std::optional<Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>> factor_; ///< sparse
  EvenShares shares_;                                                       ///< spread: of the rows
  Eigen::MatrixXd rows_; ///< likewise: this rank's, as columns
  mutable Eigen::VectorXd work_;
};

} // namespace epafi::fetidp
