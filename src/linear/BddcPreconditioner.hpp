#pragma once

/// The same decomposition as a preconditioner of the assembled K: balancing domain decomposition by constraints, BDDC (Dohrmann,
/// *SIAM J. Sci. Comput.* 25 (2003)). A residual is condensed to the interface, shared out among the subdomains, solved for by K̄⁻¹,
/// the solution is averaged at the copies, and the interiors follow:
///   M⁻¹ = (K_II⁻¹ 0; 0 0) + H E_D K̄⁻¹ E_Dᵀ Hᵀ,
/// H the discrete harmonic extension into the interiors, E_D the mean at the copies. With the coarse unknowns and weights of
/// FETI-DP, M⁻¹K has the eigenvalues of F with the Dirichlet preconditioner, and some that are 1; none is smaller (Mandel,
/// Dohrmann, Tezaur, *Appl. Numer. Math.* 54 (2005)).

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/linear/BoundaryStiffness.hpp"
#include "epafi/linear/CopyShares.hpp"
#include "epafi/linear/LinearParameters.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <memory>

namespace epafi::linear {

/// n × n, symmetric positive definite, on the map of `k`; the identity where K is. A product takes all columns in one
/// pass: three sparse solves and two dense products a subdomain and column, six messages to each neighbour, one of the coarse
/// problem's size times the columns.
class BddcPreconditioner final : public SymmetricOperator {
public:
  /// Factorises; shares k. Collective.
  /// \throws InputError if the problem has rows of contact or an entry that is no finite number, SolvabilityError (not unique)
  /// if a body floats, Error if a factorisation fails; the same on all ranks.
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
