#pragma once

/// Identical subdomains of one rank, worked on together: one factor, one condensed block, and products with
/// all of them at once as one matrix–matrix product.
///
/// With B = [B_Δ B_C] and Ψ, S as in CondensedSubdomain.hpp the dual operator is
///   F = Σ B_Δ (K_rr⁻¹)_ΔΔ B_Δᵀ + (Σ W L_c) S_cc⁺ (Σ W L_c)ᵀ,   W = B_c − B_Δ Ψ_Δ,   S_cc = Σ L_cᵀ S L_c.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/direct/SymmetricBlock.hpp"
#include "epafi/fetidp/operator/CondensedSubdomain.hpp"

#include <memory>
#include <span>
#include <vector>

namespace epafi::fetidp {

/// An entry of B, or of a matrix with B's pattern, in a group: multiplier (ghost map), place in the members'
/// boundary values (n_Δ × m) or crosspoint values (n_c × m), column by column, value.
struct InterfaceEntry {
  int multiplier, place;
  double coefficient;
};

/// values += Bᵀ λ. \param lambda  multipliers × k, column by column; \param values  n × mk
void addTransposed(std::span<const InterfaceEntry> b, std::span<const double> lambda, Eigen::Index numColumns,
                   Eigen::MatrixXd& values);
/// result += B values, likewise.
void addProduct(std::span<const InterfaceEntry> b, const Eigen::MatrixXd& values, Eigen::Index numColumns,
                std::span<double> result);

/// m members; n_r, n_Δ, n_c as in CondensedSubdomain. What is multiplied or solved for has k ≥ 1 columns;
/// multipliers and coarse unknowns lie column by column. Products leave the group as it is: whoever
/// multiplies owns the work space, which also carries the first half of a product to the second. Nothing here
/// is collective.
class SubdomainGroup {
public:
  /// Of one product at a time; sized by the first half.
  struct Workspace {
    Eigen::MatrixXd forces; ///< B_Δᵀλ, n_Δ × mk
    Eigen::MatrixXd
        displacement; ///< of the boundaries, n_Δ × mk; crosspoints are held until the second half moves them
    Eigen::MatrixXd crosspointForces; ///< n_c × mk
    Eigen::MatrixXd crosspointValues; ///< n_c × mk
    Eigen::MatrixXd rhs, solution;    ///< of sparse solves, n_r × a few
  };

  /// \param identical    see groupIdentical; at least one
  /// \param crosspoints  this rank's coarse unknowns, ascending: `coarse` below is numbered like them
  /// \param previous  a group of earlier times, before K^s or B changed, or null: what still holds of its
  /// factor and its block is used again Keeps a reference to `subdomains`, which must outlive it. \throws
  /// Error if the factorisation fails.
  SubdomainGroup(const std::vector<decomposition::Subdomain>& subdomains, IdenticalSubdomains identical,
                 std::span<const decomposition::CoarseNumber> crosspoints, direct::Factorizer& factorizer,
                 const SubdomainGroup* previous = nullptr);

  [[nodiscard]] const CondensedSubdomain& condensed() const { return *condensed_; }
  [[nodiscard]] std::span<const std::size_t> members() const { return members_; }
  /// How many are like the members, they included.
  [[nodiscard]] int numOnAllRanks() const { return numOnAllRanks_; }
  /// How dense blocks of the group are used: the same on any number of ranks, and with it the last digit of
  /// products.
  [[nodiscard]] direct::SymmetricBlock::Use use() const { return use_; }
  /// Global coarse index of each crosspoint value of a member.
  [[nodiscard]] std::span<const decomposition::CoarseNumber> crosspointIndices(std::size_t member) const {
    return (*subdomains_)[members_[member]].crosspointIndices;
  }
  /// B's entries in the members' boundaries, member after member.
  [[nodiscard]] std::span<const InterfaceEntry> boundaryEntries() const { return boundaryEntries_; }

  /// From now on (K_rr⁻¹)_ΔΔ is a dense block, not a pair of solves with the end of its factor.
  void makeExplicit();
  [[nodiscard]] bool isExplicit() const { return isExplicit_; }
  /// S_ΔΔ and its inverse. A subdomain alone keeps them as blocks, for F and for preconditioners: they are
  /// there.
  [[nodiscard]] CondensedBoundary condensedBoundary();
  /// Whether both work with one factor.
  [[nodiscard]] bool sharesFactorWith(const SubdomainGroup& other) const {
    return condensed_ == other.condensed_;
  }

  /// S_ΔΔ as a dense block for preconditioners, made when it is first asked for, and kept as long as the
  /// factor is.
  [[nodiscard]] std::shared_ptr<const direct::SymmetricBlock>
  boundaryStiffness(direct::SymmetricBlock::Precision precision) const;

  /// First half of F's part: (K_rr⁻¹)_ΔΔ B_Δᵀ λ, and `coarse` += L_cᵀ Wᵀ λ.
  /// \param lambda  this rank's multipliers (ghost map) × k
  /// \param coarse  this rank's coarse unknowns × k
  void applyFlexibility(std::span<const double> lambda, std::span<AccurateSum> coarse, int numColumns,
                        Workspace& work) const;
  /// Second half, with the work space of the first: result += B_Δ (K_rr⁻¹)_ΔΔ B_Δᵀ λ + W L_c x_c.
  /// \param coarse  this rank's coarse unknowns, with k columns
  /// \param result  this rank's multipliers (ghost map) × k
  void applyCoupling(const Eigen::MatrixXd& coarse, std::span<double> result, Workspace& work) const;

  /// First half of K̄⁺: adds L_cᵀ(b_c − Ψᵀ b_r) to `coarse`.
  /// \param b  of all this rank's subdomains, n_s × k each
  void eliminate(const std::vector<Eigen::MatrixXd>& b, std::span<AccurateSum> coarse, Workspace& work) const;
  /// Second half: u_c = L_c x_c, u_r = K_rr⁻¹(b_r − K_rc u_c). Needs nothing of the first.
  /// \param u  of all this rank's subdomains; the members' are overwritten
  void substitute(const Eigen::MatrixXd& coarse, const std::vector<Eigen::MatrixXd>& b,
                  std::vector<Eigen::MatrixXd>& u, Workspace& work) const;

  /// x_c of the members' crosspoint values, which agree. \param coarse this rank's coarse unknowns, with as
  /// many columns
  void takeCrosspoints(const std::vector<Eigen::MatrixXd>& u, Eigen::MatrixXd& coarse) const;

  /// b −= Bᵀ λ in the members. \param lambda  on the ghost map × k
  void subtractForces(std::span<const double> lambda, std::vector<Eigen::MatrixXd>& b) const;
  /// result += B u of the members. \param result  on the ghost map × k
  void addConstraint(const std::vector<Eigen::MatrixXd>& u, std::span<double> result) const;

  /// Bytes of the factor, and of the dense block.
  [[nodiscard]] std::size_t factorBytes() const;
  /// Bytes that one product with F reads of factor or block.
  [[nodiscard]] std::size_t applyBytes() const;

private:
  [[nodiscard]] Eigen::Index numMembers() const { return members_.size(); }
  [[nodiscard]] bool fits(const decomposition::Subdomain& subdomain,
                          const SubdomainInterface& interface) const;
  /// Column j of the members' values: member after member, then the next of k.
  template <class Values>
  [[nodiscard]] auto columnOf(Values& of, Eigen::Index j) const {
    return of[members_[j % numMembers()]].col(j / numMembers());
  }
  void addEntries(std::size_t member, std::size_t subdomain);
  void solveForBoundary(Workspace& work) const;
  [[nodiscard]] Eigen::Index prepareBatch(Eigen::Index numLeft, Workspace& work) const;
  void addToCoarse(const Eigen::MatrixXd& crosspointForces, std::span<AccurateSum> coarse) const;
  void takeFromCoarse(const Eigen::MatrixXd& coarse, Eigen::MatrixXd& crosspointValues) const;

  const std::vector<decomposition::Subdomain>* subdomains_;
  std::vector<std::size_t> members_;
  int numOnAllRanks_;
  direct::SymmetricBlock::Use use_;
  std::weak_ptr<const decomposition::SparseMatrix> stiffness_; ///< what was condensed, not kept alive by this
  std::vector<int> crosspointUnknowns_;                        ///< likewise
  std::shared_ptr<const CondensedSubdomain> condensed_;
  std::vector<InterfaceEntry> boundaryEntries_, crosspointEntries_; ///< member after member
  Eigen::MatrixXi coarseIndices_;                                   ///< n_c × m, L_c
  std::shared_ptr<const direct::SymmetricBlock> flexibility_;       ///< (K_rr⁻¹)_ΔΔ, once it was made
  bool isExplicit_ = false;
  mutable std::shared_ptr<const direct::SymmetricBlock> boundaryStiffness_; ///< S_ΔΔ, likewise
};

} // namespace epafi::fetidp
