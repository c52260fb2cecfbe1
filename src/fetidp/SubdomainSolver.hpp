#pragma once

/// One subdomain condensed: K_rr factorised, and what couples its crosspoints to its multipliers.
///
/// With the unknowns split in remainder (r) and crosspoints (c), B = [B_r B_c] and
///   W = B_c − B_r K_rr⁻¹ K_rc,   S = K_cc − K_cr K_rr⁻¹ K_rc,
/// the dual operator is F = Σ B_r K_rr⁻¹ B_rᵀ + (Σ W L_c) S_cc⁺ (Σ W L_c)ᵀ with S_cc = Σ L_cᵀ S L_c: one
/// sparse solve a subdomain and product.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/direct/SpdFactor.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace epafi::fetidp {

/// Numbers of a subdomain: n_r remainder and n_c crosspoint unknowns, n_b multipliers that touch it.
class SubdomainSolver {
public:
  /// Factorises K_rr by `directSolver` and computes W and S. Keeps a reference to `subdomain`, which must
  /// outlive it. Not collective. \throws Error if the factorisation fails.
  SubdomainSolver(const decomposition::Subdomain& subdomain, const std::string& directSolver);

  /// S, n_c × n_c, symmetric positive semidefinite.
  [[nodiscard]] const Eigen::MatrixXd& schurComplement() const { return schurComplement_; }
  /// Global coarse index of each crosspoint unknown.
  [[nodiscard]] std::span<const GlobalOrdinal> crosspointIndices() const {
    return subdomain_->crosspointIndices;
  }

  /// First half of F's part: keeps B_r K_rr⁻¹ B_rᵀ λ and adds L_cᵀ Wᵀ λ to `coarse`.
  /// \param lambda  this rank's multipliers (ghost map)
  /// \param coarse  all coarse unknowns
  void applyFlexibility(std::span<const double> lambda, std::span<AccurateSum> coarse);
  /// Second half: result += B_r K_rr⁻¹ B_rᵀ λ + W L_c x_c, in one addition an entry, so that the result does
  /// not depend on which rank holds which subdomain.
  /// \param result  this rank's multipliers (ghost map)
  void applyCoupling(const Eigen::VectorXd& coarse, std::span<double> result) const;

  /// First half of K̄⁺: keeps y = K_rr⁻¹ b_r and adds L_cᵀ(b_c − K_cr y) to `coarse`.
  /// \param b  n_s values
  void eliminate(const Eigen::VectorXd& b, std::span<AccurateSum> coarse);
  /// Second half: u_r = y − K_rr⁻¹ K_rc u_c, u_c = L_c x_c.
  /// \param u  n_s values, overwritten
  void substitute(const Eigen::VectorXd& coarse, Eigen::VectorXd& u);

  /// b −= Bᵀ λ.
  /// \param b  n_s values
  void subtractForces(std::span<const double> lambda, Eigen::VectorXd& b) const;
  /// result += B u.
  /// \param u  n_s values
  void addConstraint(const Eigen::VectorXd& u, std::span<double> result) const;

  [[nodiscard]] std::size_t factorBytes() const;

private:
  struct Entry { ///< one entry of B_r: row among the n_b multipliers, column among the n_r remainders
    int row, column;
    double coefficient;
  };

  void addToCoarse(std::span<AccurateSum> coarse) const;
  void takeFromCoarse(const Eigen::VectorXd& coarse) const;
  void splitConstraint();
  void condense();

  const decomposition::Subdomain* subdomain_;
  std::unique_ptr<direct::SpdFactor> factor_;          ///< K_rr
  decomposition::SparseMatrix remainderToCrosspoint_;  ///< K_rc, n_r × n_c
  std::vector<int> multipliers_;                       ///< the n_b multipliers, as indices of the ghost map
  std::vector<Entry> remainderConstraint_;             ///< B_r
  Eigen::MatrixXd coupling_;                           ///< W, n_b × n_c
  Eigen::MatrixXd schurComplement_;                    ///< S
  Eigen::VectorXd remainder_, solution_, flexibility_; ///< work: n_r, n_r, n_b
  mutable Eigen::VectorXd local_, localCoarse_;        ///< work: n_b, n_c
};

} // namespace epafi::fetidp
