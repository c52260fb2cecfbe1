#pragma once

/// The same decomposition as a preconditioner of the assembled K: balancing domain decomposition by
/// constraints, BDDC (Dohrmann, *SIAM J. Sci. Comput.* 25 (2003)). A residual is condensed to the interface,
/// shared out among the subdomains, solved for by K̄⁻¹, the solution is averaged at the copies, and the
/// interiors follow:
///   M⁻¹ = (K_II⁻¹ 0; 0 0) + H E_D K̄⁻¹ E_Dᵀ Hᵀ,
/// H the discrete harmonic extension into the interiors, E_D the mean at the copies. With the coarse unknowns
/// and weights of FETI-DP, M⁻¹K has the eigenvalues of F with the Dirichlet preconditioner, and some that are
/// 1; none is smaller (Mandel, Dohrmann, Tezaur, *Appl. Numer. Math.* 54 (2005)).

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/direct/SymmetricBlock.hpp"
#include "epafi/linear/LinearParameters.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <memory>
#include <vector>

namespace epafi::linear {

/// S_ΔΔ, the stiffness of each subdomain condensed to its boundary Δ while its crosspoints are held
/// (fetidp/CondensedSubdomain.hpp).
/// A dense block for each group of identical subdomains; nothing is collective.
class BoundaryStiffness {
public:
  /// Shares `inverse`. \throws std::bad_alloc
  BoundaryStiffness(const decomposition::DecomposedProblem& problem,
                    std::shared_ptr<const fetidp::GeneralizedInverse> inverse);

  /// forces_Δ = S_ΔΔ u_Δ in all columns of all subdomains; the other entries become 0.
  void apply(const SubdomainVectors& u, SubdomainVectors& forces) const;
  /// Unknowns of the boundary of this rank's subdomain s, in the order of the blocks.
  [[nodiscard]] const std::vector<int>& boundary(std::size_t s) const { return boundary_[s]; }
  [[nodiscard]] std::size_t bytes() const;

private:
  std::shared_ptr<const fetidp::GeneralizedInverse> inverse_;
  std::vector<std::shared_ptr<const direct::SymmetricBlock>> blocks_; ///< of each group
  std::vector<std::vector<int>> boundary_;                            ///< of each subdomain
  mutable Eigen::MatrixXd input_, output_;                            ///< work, n_Δ × mk
};

/// n × n, symmetric positive definite, on the map of `k`; the identity where K is. A product takes all
/// columns in one pass: three sparse solves and two dense products a subdomain and column, six messages to
/// each neighbour, one of the coarse problem's size times the columns.
class BddcPreconditioner final : public SymmetricOperator {
public:
  /// Factorises; shares k. Collective.
  /// \throws InputError if the problem has rows of contact or an entry that is no finite number,
  /// SolvabilityError (not unique) if a body floats, Error if a factorisation fails; the same on all ranks.
  BddcPreconditioner(RCP<const UnassembledOperator> k, const BddcParameters& parameters);

  [[nodiscard]] const fetidp::GeneralizedInverse& inverse() const { return *inverse_; }
  /// Bytes of this rank's factors and blocks.
  [[nodiscard]] std::size_t bytes() const { return inverse_->factorBytes() + stiffness_.bytes(); }

private:
  void multiply(const MultiVector& x, MultiVector& y) const override;

  void condenseInteriors(int numColumns) const;
  void shareOut() const;
  void average() const;
  void extendIntoInteriors(int numColumns) const;

  RCP<const UnassembledOperator> k_;
  std::shared_ptr<const fetidp::GeneralizedInverse> inverse_;
  CopyShares shares_;
  BoundaryStiffness stiffness_;
  mutable SubdomainVectors forces_, values_;  ///< work: what acts on the subdomains, and what they answer
  mutable SubdomainVectors local_, reaction_; ///< work
  mutable fetidp::GeneralizedInverse::Workspace work_;
  mutable SubdomainVectors shared_; ///< work: sums over the copies
  mutable RCP<MultiVector> sum_;    ///< work
};

} // namespace epafi::linear
