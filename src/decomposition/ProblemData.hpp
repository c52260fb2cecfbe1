#pragma once

/// What of a contact problem may change from one solve to the next while its matrices stay: loads, prescribed
/// values, gaps and the bounds of friction. A problem is set up once and solved for any number of these;
/// copies are load cases.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace epafi::decomposition {

/// Loads and prescribed values of a subdomain. Its right-hand side is `load` − `reaction`.
struct SubdomainData {
  Eigen::VectorXd load;       ///< f^s, n_s: forces at its unknowns, such that fᵀũ is their work
  Eigen::VectorXd reaction;   ///< K_fp u_p, n_s: what prescribed values u_p alone ask of the unknowns
  Eigen::VectorXd prescribed; ///< u_p at each position (nodes × components), 0 at the free ones
  double heldLoad = 0;        ///< sum of the sizes of the loads at prescribed values
  Eigen::VectorXd heldForces; ///< f_p, as HeldRows::positions; empty where these are
  double heldWork = 0;        ///< f_pᵀu_p
  double heldEnergy = 0;      ///< ½u_pᵀK_pp u_p

  /// f^s − K_fp u_p
  [[nodiscard]] Eigen::VectorXd rightHandSide() const { return load - reaction; }
  /// What energy prescribed values alone contribute.
  [[nodiscard]] double energyOffset() const { return heldEnergy - heldWork; }
};

/// The data of one DecomposedProblem, of this rank. Whoever assembles the problem makes them
/// (UnassembledProblem, model::decompose); everything here keeps loads, supports and energies consistent.
class ProblemData {
public:
  ProblemData() = default;
  /// \param subdomains  of this rank, in their order  \param gaps  c as given, on multiplierMap, 0 for gluing
  /// \param held        B u of the prescribed values alone, on the same map
  ProblemData(std::vector<SubdomainData> subdomains, const Vector& gaps, const Vector& held);
  ProblemData(const ProblemData& other);            ///< a load case of its own, gaps too
  ProblemData& operator=(const ProblemData& other); ///< likewise
  ProblemData(ProblemData&&) noexcept = default;
  ProblemData& operator=(ProblemData&&) noexcept = default;
  ~ProblemData() = default;

  /// Whether there are none, of any problem.
  [[nodiscard]] bool isEmpty() const { return gap_.is_null(); }
  /// Of this rank, in the order of DecomposedProblem::subdomains.
  [[nodiscard]] std::span<const SubdomainData> subdomains() const { return subdomains_; }
  /// What B̄u of the unknowns is compared with: the gaps less what prescribed values contribute. On
  /// multiplierMap.
  [[nodiscard]] const Vector& gap() const { return *gap_; }
  /// What the tangential force of a node with friction is at most: g, and μ times its normal force.
  [[nodiscard]] double frictionBound(const FrictionNode& node, double normalForce) const;
  /// Whether any node has a coefficient μ > 0, on any rank.
  [[nodiscard]] bool hasCoulombFriction() const { return hasCoulombFriction_; }

  /// All loads times a factor; prescribed values and gaps stay. Not collective.
  void scaleLoads(double factor);
  /// All prescribed values times a factor; loads and gaps stay. Not collective.
  void scaleSupports(double factor);
  /// f^s anew. Not collective. \throws InputError for another size
  /// \param subdomain  its place on this rank, of `problem`  \param forces  at all its positions in space
  void setLoad(const DecomposedProblem& problem, std::size_t subdomain, const Eigen::VectorXd& forces);
  /// c of rows of contact or ties anew; what prescribed values contribute is taken off. Not collective.
  /// \param gaps  on a map whose global indices are rows of B and are this rank's in multiplierMap, as
  /// `contactGaps` returns
  void setGaps(const Vector& gaps);
  /// g of nodes with friction anew, Tresca's law: forces, tractions times areas. 0 at first.
  /// \param bounds  of each of problem.frictionNodes, ≥ 0 \throws InputError for others, on all ranks alike.
  /// Collective.
  void setFrictionBounds(const DecomposedProblem& problem, std::span<const double> bounds);
  /// μ likewise, Coulomb's law.
  void setFrictionCoefficients(const DecomposedProblem& problem, std::span<const double> coefficients);
  /// c of the rows of contact as given last, to be changed and handed to `setGaps`. Collective.
  [[nodiscard]] RCP<Vector> contactGaps(const DecomposedProblem& problem) const;

private:
  friend class UnassembledProblem;
  std::vector<SubdomainData> subdomains_;
  RCP<Vector> gap_, held_;
  RCP<Vector> bounds_, coefficients_; ///< of friction, on multiplierMap in the first row of each node
  bool hasCoulombFriction_ = false;
};

} // namespace epafi::decomposition
