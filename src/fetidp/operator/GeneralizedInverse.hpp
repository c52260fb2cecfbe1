#pragma once

/// K̄⁺: the inverse, or a generalised inverse, of the stiffness matrix after the crosspoints are merged; and
/// B̄ around it.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/operator/CoarseProblem.hpp"
#include "epafi/fetidp/operator/FetiParameters.hpp"
#include "epafi/fetidp/operator/SubdomainGroup.hpp"

#include <memory>
#include <span>
#include <vector>

namespace epafi::fetidp {

/// Values of this rank's subdomains, n_s × k each: k ≥ 1 vectors at once, as many in every subdomain.
using SubdomainVectors = std::vector<Eigen::MatrixXd>;

/// Right-hand sides f^s − K_fp u_p of this rank's subdomains.
SubdomainVectors loadsOf(const decomposition::ProblemData& data);

/// Products leave it as it is; work space belongs to whoever multiplies.
class GeneralizedInverse {
public:
  /// Of one product at a time; its vectors get their sizes from the product.
  struct Workspace {
    std::vector<SubdomainGroup::Workspace> groups;
    std::vector<AccurateSum> coarseForces; ///< this rank's shares, coarse unknowns × k
    Eigen::MatrixXd coarseValues;          ///< likewise
  };

  /// Factorises the subdomains and the coarse problem. Keeps a reference to `problem`. Collective; throws
  /// alike on all ranks: Error if a factorisation fails. Precondition: all entries of K and B are finite
  /// (ProblemChecks.hpp).
  /// \param earlier  of the same problem and solvers, before K^s or B changed, or null. What still holds is
  /// taken over, subdomain by subdomain: the factor and the dense block where K^s is the same object and B
  /// touches the same unknowns as before; the symbolic part of the factorisation where the pattern is the
  /// same; the factor of the coarse problem if all factors and the crosspoints are the same on all ranks. Who
  /// shares it keeps a valid inverse; if nobody does, its factors go one by one as they are replaced.
  GeneralizedInverse(const decomposition::DecomposedProblem& problem, const DirectSolvers& solvers,
                     std::shared_ptr<GeneralizedInverse> earlier = nullptr);

  /// Makes dense blocks where the mode asks for them, or where they pay off. Not collective.
  void prepareDual(const DualOperatorParameters& parameters);

  /// result = B̄ K̄⁺ B̄ᵀ λ, both on this rank's multipliers (multiplierGhostMap) with k columns, one after
  /// the other: the sum of `result` over the ranks is Fλ. One message of k times the coarse problem's size.
  /// Collective.
  void applyDual(std::span<const double> lambda, std::span<double> result, int numColumns,
                 Workspace& work) const;

  /// u = K̄⁺ b. Crosspoint entries of b are contributions, summed over the subdomains; those of u agree.
  /// Collective; b has `numColumns` columns on every rank, also on one without subdomains.
  void apply(const SubdomainVectors& b, SubdomainVectors& u, int numColumns, Workspace& work) const;
  /// Once, with one column.
  void apply(const SubdomainVectors& b, SubdomainVectors& u) const {
    Workspace work;
    apply(b, u, 1, work);
  }

  /// u with the crosspoint values of `u` and the others in equilibrium: u_r = K_rr⁻¹(b_r − K_rc u_c). Not
  /// collective.
  void solveRemainders(const SubdomainVectors& b, SubdomainVectors& u, int numColumns, Workspace& work) const;

  /// b −= B̄ᵀ λ (λ on the ghost map × k). Not collective.
  void subtractForces(std::span<const double> lambda, SubdomainVectors& b) const;
  /// result = this rank's part of B̄ u (on the ghost map × k). Not collective.
  void constraint(const SubdomainVectors& u, std::span<double> result) const;

  /// S_cc⁺ of unit forces, at this rank's coarse unknowns. \param unknowns where they act, for each column;
  /// the same on every rank of a team (CoarseProblem.hpp) Collective.
  [[nodiscard]] Eigen::MatrixXd
  coarseColumns(std::span<const std::vector<decomposition::CoarseNumber>> unknowns) const;
  /// Place of a coarse unknown among this rank's, or −1.
  [[nodiscard]] decomposition::CoarsePlace coarseIndexOf(decomposition::CoarseNumber unknown) const;

  /// This rank's subdomains, identical ones together.
  [[nodiscard]] std::span<const SubdomainGroup> groups() const { return groups_; }
  [[nodiscard]] std::span<SubdomainGroup> groups() { return groups_; } ///< to make blocks that others share
  /// Bytes of this rank's factors and dense blocks.
  [[nodiscard]] std::size_t factorBytes() const;
  [[nodiscard]] const CoarseProblem& coarseProblem() const { return *coarseProblem_; } ///< S_cc
  /// From multiplierMap to multiplierGhostMap.
  [[nodiscard]] const RCP<const Import>& multiplierPlan() const { return multiplierPlan_; }

private:
  bool makeGroups(const decomposition::DecomposedProblem& problem, std::vector<SubdomainGroup> earlierGroups);
  void prepareColumns(int numColumns, Workspace& work) const;

  DirectSolvers solvers_;
  RCP<const Map> crosspointMap_;
  RCP<const Import> multiplierPlan_;
  std::vector<decomposition::CoarseNumber> crosspoints_; ///< this rank's coarse unknowns, ascending
  std::vector<SubdomainGroup> groups_;
  std::shared_ptr<const CoarseProblem> coarseProblem_;
};

} // namespace epafi::fetidp
