#pragma once

/// What a preconditioner of F does where contact touches crosspoints: these move by u = C λ, C = B_Dᵀ there,
/// against Ŝ, the others of the body follow, X u (ContactCrosspoints.hpp), and the boundaries too, each
/// subdomain for itself, −Ψ_Δ X u. So they come apart: they jump by J u.

#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"
#include "epafi/fetidp/precondition/ConstrainedCrosspoints.hpp"
#include "epafi/fetidp/precondition/ContactCrosspoints.hpp"
#include "epafi/fetidp/precondition/ScaledConstraint.hpp"

#include "epafi/qp/operators/DeflatedOperator.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace epafi::fetidp {

/// n_C crosspoint values that contact touches, n_N near ones.
class CrosspointMotion {
public:
  /// Shares `inverse`. \param deflated  F with adaptive constraints, which bodies then keep
  /// where they follow crosspoints; null without. Collective.
  CrosspointMotion(const decomposition::DecomposedProblem& problem,
                   std::shared_ptr<const GeneralizedInverse> inverse, ContactCrosspoints crosspoints,
                   const ScaledConstraint& scaled, const RCP<const qp::DeflatedOperator>& deflated);

  /// u = C λ, n_C × k on every rank of the crosspoints' comm, and what is left for the boundaries, rest = λ −
  /// J u. Two messages, of n_C numbers a column in this comm and to the neighbours, one more to these if it
  /// is not that of all ranks, and a product with Ψ_Δ a subdomain and column. Collective.
  void split(const MultiVector& lambda, Eigen::MatrixXd& u, MultiVector& rest) const;
  /// y += Cᵀ(Ŝ u − Jᵀ y); likewise, with n_N numbers.
  void addForces(const Eigen::MatrixXd& u, MultiVector& y) const;
  /// y += Cᵀ(Xᵀ(f − K v)_C − Jᵀ y), what crosspoints at rest miss for equilibrium where the bodies are
  /// displaced by v (n_s × 1); without the first term under adaptive constraints. Collective.
  void addForcesAtRest(const decomposition::DecomposedProblem& problem, const SubdomainVectors& f,
                       const SubdomainVectors& v, MultiVector& y) const;

private:
  /// A group of identical subdomains some of whose crosspoints are near: m members.
  struct Follower {
    const SubdomainGroup* group;
    Eigen::MatrixXi near; ///< n_c × m: index among the near ones of each crosspoint value, or −1
  };
  struct FollowerWork {
    Eigen::MatrixXd atCrosspoints, atBoundary; ///< displacements or forces, n_c × mk and n_Δ × mk
  };
  struct Workspace {
    MultiplierExchange input, output;
    std::vector<FollowerWork> followers;
    std::vector<AccurateSum> touchedSums, nearSums; ///< n_C × k and n_N × k
    Eigen::MatrixXd nearDisplacement, nearForces;   ///< n_N × k
    Eigen::MatrixXd forces;                         ///< at the touched ones, n_C × k
    RCP<MultiVector> shared;                        ///< y over the shares
  };
  void takeShares(const ScaledConstraint& scaled);
  void takeWeights(const ScaledConstraint& scaled, const Map& map);
  void findFollowers();
  void constrain(const decomposition::DecomposedProblem& problem, const qp::DeflatedOperator& deflated);
  void prepareColumns(std::size_t numColumns) const;
  void negativeJumps(MultiVector& jumps) const;
  void addForcesOfJumps() const;
  void pullBack(const Eigen::MatrixXd& u, MultiVector& y) const;

  std::shared_ptr<const GeneralizedInverse> inverse_;
  ContactCrosspoints crosspoints_;
  std::optional<ConstrainedCrosspoints> constrained_; ///< where there are adaptive constraints
  /// Whether the crosspoints are those of some ranks, whose subdomains then have C's rows, not the rows'
  /// owners
  bool isLocal_;
  std::vector<ScaledConstraint::CrosspointEntry>
      weights_; ///< C, row by row: of rows on the ghost map if local, else of this rank's
  std::vector<double> inverseShares_; ///< of the rows of this rank: 1/Σ b_i B_D,i over the boundary
  std::vector<Follower> followers_;
  mutable Workspace work_;
};

} // namespace epafi::fetidp
