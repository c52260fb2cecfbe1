#pragma once

/// Preconditioners of F, built from the condensed subdomains: M = Σ B_D S_Δ B_Dᵀ + what contact at crosspoints needs
/// (ContactCrosspoints.hpp), where S_Δ is
///   dirichlet  the stiffness of a subdomain condensed to its boundary, S_ΔΔ (Farhat, Roux, *Int. J. Numer. Meth.
///              Engng* 32 (1991); for FETI-DP Klawonn, Widlund, *Comm. Pure Appl. Math.* 59 (2006))
///   lumped     the block K_ΔΔ of the boundary alone: cheaper, and weaker
/// and B_D is B with its entries scaled row by row,
///   b_i → (b_i/δ_i) / Σ_k b_k²/δ_k,
/// δ = 1 for multiplicity scaling, δ = the diagonal of K^s (at crosspoints, of K̄) for stiffness (ρ) scaling. Rows of contact are treated like
/// those of gluing. MPRGP uses M restricted to its free set ("in face").

#include "epafi/fetidp/ContactCrosspoints.hpp"
#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"

#include <Tpetra_Operator.hpp>

#include <memory>
#include <vector>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite: every row of B touches a free unknown, or it gets a 1 on the diagonal.
class DualPreconditioner final : public Operator {
public:
  /// Shares `inverse`, and keeps a reference to `problem`. Precondition: type is not none. Collective.
  DualPreconditioner(const decomposition::DecomposedProblem& problem,
                     std::shared_ptr<GeneralizedInverse> inverse, const PreconditionerParameters& parameters);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  /// y = alpha M x + beta y, all columns in one pass: two neighbour exchanges, one dense product a subdomain and column,
  /// and, where contact touches crosspoints, two messages of n_C and n_N numbers a column. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }
  /// Bytes of this rank's blocks; what an application reads.
  [[nodiscard]] std::size_t bytes() const;

private:
  /// What a group of identical subdomains needs: m members, n_Δ boundary unknowns.
  struct Block {
    std::size_t group = 0; ///< index in the inverse's groups
    direct::SymmetricBlock stiffness;
    std::vector<double> weights;   ///< B_D's entries in the order of SubdomainGroup::boundaryEntries
    Eigen::MatrixXd input, output; ///< work, n_Δ × mk
  };
  /// An entry of B_D at a crosspoint value.
  struct CrosspointEntry {
    int multiplier, touched; ///< on the ghost map; index in ContactCrosspoints
    double weight;
  };
  /// A member that contact touches next to a crosspoint: u_Δ follows −Ψ_Δ u_c in the rows of contact.
  struct Follower {
    std::size_t block;
    Eigen::Index member, numMembers;
    std::vector<int> boundary;    ///< positions in Δ that contact touches
    std::vector<int> crosspoints; ///< the near crosspoints (see ContactCrosspoints) of a column of `response`
    Eigen::MatrixXd response;     ///< Ψ there
  };
  void makeBlocks(const decomposition::DecomposedProblem& problem, PreconditionerParameters::Type type,
                  bool isSingle);
  void findFollowers(const decomposition::DecomposedProblem& problem);
  Eigen::VectorXd crosspointStiffness(const decomposition::DecomposedProblem& problem);
  void scale(const decomposition::DecomposedProblem& problem, PreconditionerParameters::Scaling scaling);
  [[nodiscard]] int touchedIndexOf(const decomposition::Subdomain& subdomain, int unknown) const;
  void prepareColumns(Eigen::Index numColumns) const;
  void gather(std::span<const double> lambda) const;
  void followCrosspoints() const;
  void multiply() const;
  void scatter(std::span<double> result) const;

  RCP<const Map> map_;
  std::shared_ptr<GeneralizedInverse> inverse_;
  ContactCrosspoints crosspoints_;
  mutable std::vector<Block> blocks_;
  std::vector<CrosspointEntry> crosspointEntries_;
  std::vector<Follower> followers_;
  mutable std::vector<AccurateSum> touchedSums_, nearSums_;                       ///< work, n_C k and n_N k
  mutable Eigen::MatrixXd displacement_, forces_, nearDisplacement_, nearForces_; ///< work, likewise
  std::vector<int> untouched_; ///< rows without a free unknown, local indices
  mutable MultiplierExchange input_, output_;
  mutable RCP<MultiVector> result_;
};

} // namespace epafi::fetidp
