#pragma once

/// K̄⁺: the inverse, or a generalised inverse, of the stiffness matrix after the crosspoints are merged; and B̄
/// around it.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/fetidp/CoarseProblem.hpp"
#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/fetidp/SubdomainGroup.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace epafi::fetidp {

/// Values of this rank's subdomains, n_s × k each: k ≥ 1 vectors at once, as many in every subdomain.
using SubdomainVectors = std::vector<Eigen::MatrixXd>;

class GeneralizedInverse {
public:
  /// Factorises the subdomains and the coarse problem. Keeps a reference to `problem`. Collective; throws
  /// alike on all ranks: Error if a factorisation fails. Precondition: all entries of K and B are finite (FiniteData.hpp).
  GeneralizedInverse(const decomposition::DecomposedProblem& problem, const DirectSolvers& solvers);

  /// Follows changes of K^s and B in the problem: what still holds is kept, subdomain by subdomain. That is the factor and
  /// the dense block where K^s is the same object and B touches the same unknowns as before; the symbolic part of the
  /// factorisation where the pattern is the same; the factor of the coarse problem if all factors and the crosspoints are
  /// the same on all ranks. Every object that keeps a reference to this one is to be made anew. Collective; throws as the
  /// constructor does.
  void update(const decomposition::DecomposedProblem& problem);

  /// Makes dense blocks where the mode asks for them, or where they pay off. Not collective.
  void prepareDual(const DualOperatorParameters& parameters);

  /// result = B̄ K̄⁺ B̄ᵀ λ, both on this rank's multipliers (multiplierGhostMap) with k columns, one after the other:
  /// the sum of `result` over the ranks is Fλ. One message of k times the coarse problem's size. Collective.
  void applyDual(std::span<const double> lambda, std::span<double> result, int numColumns = 1);

  /// u = K̄⁺ b. Crosspoint entries of b are contributions, summed over the subdomains; those of u agree.
  /// Collective; b has `numColumns` columns on every rank, also on one without subdomains.
  void apply(const SubdomainVectors& b, SubdomainVectors& u, int numColumns = 1);

  /// u with the crosspoint values of `u` and the others in equilibrium: u_r = K_rr⁻¹(b_r − K_rc u_c). Not collective.
  void solveRemainders(const SubdomainVectors& b, SubdomainVectors& u, int numColumns = 1);

  /// b −= B̄ᵀ λ (λ on the ghost map × k). Not collective.
  void subtractForces(std::span<const double> lambda, SubdomainVectors& b) const;
  /// result = this rank's part of B̄ u (on the ghost map × k). Not collective.
  void constraint(const SubdomainVectors& u, std::span<double> result) const;

  /// Columns of S_cc⁺ at this rank's coarse unknowns; valid until the next call of any function.
  /// \param isOwner  of each of `unknowns`: true on exactly one rank, which must have it
  /// Collective.
  const Eigen::MatrixXd& coarseColumns(std::span<const GlobalOrdinal> unknowns,
                                       const std::vector<bool>& isOwner);
  /// Place of a coarse unknown among this rank's, or −1.
  [[nodiscard]] int coarseIndexOf(GlobalOrdinal unknown) const;

  /// This rank's subdomains, identical ones together.
  [[nodiscard]] std::span<SubdomainGroup> groups() { return groups_; }
  [[nodiscard]] std::span<const SubdomainGroup> groups() const { return groups_; } ///< likewise
  /// Bytes of this rank's factors and dense blocks.
  [[nodiscard]] std::size_t factorBytes() const;
  [[nodiscard]] const CoarseProblem& coarseProblem() const { return *coarseProblem_; } ///< S_cc
  /// From multiplierMap to multiplierGhostMap.
  [[nodiscard]] const RCP<const Import>& multiplierPlan() const { return multiplierPlan_; }

private:
  bool makeGroups(const decomposition::DecomposedProblem& problem);
  void prepareCoarse(int numColumns);

  DirectSolvers solvers_;
  RCP<const Map> crosspointMap_;
  RCP<const Import> multiplierPlan_;
  std::vector<GlobalOrdinal> crosspoints_; ///< this rank's coarse unknowns, ascending
  std::vector<SubdomainGroup> groups_;
  std::unique_ptr<CoarseProblem> coarseProblem_;
  std::vector<AccurateSum> coarseSums_; ///< work, of this rank's coarse unknowns × k
  Eigen::MatrixXd coarse_;              ///< work, likewise
};

} // namespace epafi::fetidp
