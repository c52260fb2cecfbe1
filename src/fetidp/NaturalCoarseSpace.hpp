#pragma once

/// Equilibrium of the floating clusters of subdomains, most often whole bodies: G̃ = Rᵀ B̄ᵀ, ẽ = Rᵀ f̄, made orthonormal: G = T̃ G̃ with GGᵀ = I, e = T̃ ẽ;
/// the projectors Q = GᵀG on Im Gᵀ and P = I − Q on Ker G; the feasible λ̃ = Gᵀe.
///
/// The kernel R of a cluster satisfies the gluing inside, so that G̃ has entries in the rows of contact and ties, and in those that
/// glue clusters, each touching a few clusters: it is kept sparse, by rows of B. T̃ is the inverse of the Cholesky factor of
/// G̃G̃ᵀ (k × k on every rank).

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/qp/EqualityConstraint.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::fetidp {

/// One entry of G̃ᵀ in a row that this rank owns.
struct KernelEntry {
  int row;  ///< local index in multiplierMap
  int mode; ///< column of R
  double value;
};

/// G̃ᵀ by rows, this rank's. Collective.
std::vector<KernelEntry> kernelConstraint(const decomposition::DecomposedProblem& problem);

/// The same of whole bodies, which gluing does not hold: columns are the bodies' modes. \param entries  see kernelConstraint
/// Not collective.
std::vector<KernelEntry> kernelConstraintOfBodies(const decomposition::DecomposedProblem& problem,
                                                  const std::vector<KernelEntry>& entries);

/// ẽ = Rᵀ f̄ for the loads that the problem holds, on every rank. Collective.
Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem);
/// Likewise for other loads, n_s × 1 of each of this rank's subdomains.
Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem, const SubdomainVectors& loads);

/// Resultants on whole bodies of those on clusters. Not collective.
Eigen::VectorXd onBodies(const decomposition::DecomposedProblem& problem, const Eigen::VectorXd& resultants);

/// Bounds of what they would be if nothing in them cancelled. Collective.
Eigen::VectorXd magnitudesOnBodies(const decomposition::DecomposedProblem& problem);

/// |R|ᵀ|f̄|: what ẽ would be if nothing in it cancelled, its yardstick. On every rank. Collective.
Eigen::VectorXd kernelLoadMagnitude(const decomposition::DecomposedProblem& problem);

class NaturalCoarseSpace final : public qp::ReplicatedEquality {
public:
  /// \param entries  see kernelConstraint
  /// Precondition: G̃ has full row rank (see Solvability.hpp, which says so in the user's words). Collective.
  /// \throws Error if it has not.
  NaturalCoarseSpace(const decomposition::DecomposedProblem& problem, std::vector<KernelEntry> entries);

  [[nodiscard]] int size() const override { return static_cast<int>(cholesky_.rows()); }
  void addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const override;
  void finishProduct(std::span<const AccurateSum> sums, std::span<double> gx) const override;
  void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const override;

  using qp::ReplicatedEquality::product;
  /// Gx on every rank, valid until the next call. Collective.
  [[nodiscard]] const Eigen::VectorXd& product(const Vector& x) const;
  /// x ← Px = x − Gᵀ(Gx). One message of k numbers. Collective.
  void project(Vector& x) const;
  /// e = T̃ ẽ. Not collective.
  [[nodiscard]] Eigen::VectorXd normalized(const Eigen::VectorXd& kernelLoad) const;
  /// The motion α of the bodies that μ stands for: Gᵀμ = G̃ᵀα. Not collective.
  [[nodiscard]] Eigen::VectorXd motionOf(std::span<const double> mu) const;
  /// λ̃ = Gᵀe, the shortest λ with Gλ = e. Not collective.
  void feasiblePoint(const Eigen::VectorXd& e, Vector& lambda) const;

private:
  RCP<const Comm> comm_;
  std::vector<KernelEntry> entries_;
  Eigen::MatrixXd cholesky_; ///< L with G̃G̃ᵀ = LLᵀ, lower triangle
  mutable std::vector<AccurateSum> sums_;
  mutable Eigen::VectorXd work_, product_;
};

} // namespace epafi::fetidp
