#pragma once

/// The crosspoint values that contact touches. Gluing never asks a crosspoint to move, since its copies
/// agree; contact does, and the body follows as a whole. A preconditioner made of single subdomains, the
/// others held, would be far too stiff there: its condition would grow with the number of subdomains along
/// the contact. So the displacement that contact asks of a body is split: the crosspoints that contact
/// touches move against Ŝ, the stiffness of the whole body condensed to them (the Schur complement of S_cc),
/// and take all others of the body along (a hierarchical basis, as in Smith, Widlund, *SIAM J. Sci. Stat.
/// Comput.* 11 (1990)); DualPreconditioner.hpp says what is left for the boundaries.
///
/// Likewise at the borders of clusters, in whose jumps no crosspoint takes part: the averages of the edges
/// that end there move with the faces around them (EdgeEnds.hpp), as far as no row touches them.

#include "epafi/fetidp/operator/GeneralizedInverse.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fetidp {

class ContactCrosspoints {
public:
  /// Those of the clusters of so many ranks. Costs as many coarse solves, sixteen at once, as contact touches
  /// crosspoint values of one cluster at most.
  /// \param comm  these ranks: the team of the coarse problem (CoarseProblem.hpp), or all
  /// Collective.
  ContactCrosspoints(const decomposition::DecomposedProblem& problem, const GeneralizedInverse& inverse,
                     RCP<const Comm> comm);

  [[nodiscard]] const RCP<const Comm>& comm() const { return comm_; } ///< as given
  /// Number of the crosspoint values, n_C; the same on all these ranks.
  [[nodiscard]] Eigen::Index size() const { return touched_.size(); }
  /// Number of the near ones, n_N; likewise.
  [[nodiscard]] Eigen::Index numNear() const { return near_.size(); }
  /// Index of a coarse unknown among them, or −1.
  [[nodiscard]] int indexOf(decomposition::CoarseNumber coarseUnknown) const;
  /// Whether a coarse unknown follows the faces at its edge's ends: no row touches it.
  [[nodiscard]] bool follows(decomposition::CoarseNumber coarseUnknown) const;
  /// The index of an unknown of a subdomain; −1 if it is a remainder.
  [[nodiscard]] int indexOf(const decomposition::Subdomain& subdomain, decomposition::Unknown unknown) const;
  /// Index of a coarse unknown among the n_N *near* ones, all those of clusters with touched ones, or −1.
  [[nodiscard]] int nearIndexOf(decomposition::CoarseNumber coarseUnknown) const;
  /// near = X u: how the near ones follow. u: n_C × k, near: n_N × k. Not collective.
  void extend(const Eigen::MatrixXd& u, Eigen::MatrixXd& near) const;
  /// forces = Ŝ u + Xᵀ near. Not collective.
  void forcesOf(const Eigen::MatrixXd& u, const Eigen::MatrixXd& near, Eigen::MatrixXd& forces) const;
  /// X, n_N × n_C, and Ŝ, n_C × n_C, symmetric positive definite; with the zeros between clusters.
  [[nodiscard]] Eigen::MatrixXd extension() const;
  [[nodiscard]] Eigen::MatrixXd stiffness() const;

private:
  /// Of one cluster: S_cc⁺ joins nothing else.
  struct Block {
    std::vector<int> touched, near;       ///< indices
    Eigen::MatrixXd stiffness, extension; ///< Ŝ and X there, on each of the ranks
  };
  void findBlocks(const std::vector<int>& clusters);
  void fillBlocks(const decomposition::DecomposedProblem& problem, const GeneralizedInverse& inverse);

  RCP<const Comm> comm_;
  std::vector<decomposition::CoarseNumber> touched_, following_,
      near_; ///< ascending; the second are among the first
  std::vector<Block> blocks_;
  mutable Eigen::VectorXd touchedWork_, sumWork_, nearWork_; ///< as long as the largest block asks for
};

} // namespace epafi::fetidp
