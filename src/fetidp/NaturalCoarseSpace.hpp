#pragma once

/// Equilibrium of the floating clusters of subdomains, most often whole bodies: G̃ and ẽ (KernelConstraint.hpp) made orthonormal, G = T̃ G̃ with
/// GGᵀ = I, e = T̃ ẽ; the projectors Q = GᵀG on Im Gᵀ and P = I − Q on Ker G; the feasible λ̃ = Gᵀe.
///
/// T̃ = L⁻¹Π of the sparse Cholesky factorisation ΠG̃G̃ᵀΠᵀ = LLᵀ (KernelGram.hpp), with a permutation Π that keeps L sparse; on every rank.

#include "epafi/fetidp/KernelGram.hpp"
#include "epafi/qp/EqualityConstraint.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace epafi::fetidp {

class NaturalCoarseSpace final : public qp::ReplicatedEquality {
public:
  /// \param entries  see kernelConstraint
  /// Precondition: G̃ has full row rank (see Solvability.hpp, which says so in the user's words). Collective.
  /// \throws Error if it has not.
  NaturalCoarseSpace(const decomposition::DecomposedProblem& problem, std::vector<KernelEntry> entries);

  [[nodiscard]] int size() const override { return gram_->size(); }
  void addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const override;
  void finishProduct(std::span<const AccurateSum> sums, std::span<double> gx) const override;
  void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const override;
  /// Dense where whole bodies float, sparse where clusters do (ClusterFaceInverse.hpp).
  [[nodiscard]] std::unique_ptr<qp::FaceInverse> faceInverse(const RCP<const Map>& map) const override;

  using qp::ReplicatedEquality::product;
  /// Gx on every rank, valid until the next call. Collective.
  [[nodiscard]] const Eigen::VectorXd& product(const Vector& x) const;
  /// x ← Px = x − Gᵀ(Gx). One message of k numbers. Collective.
  void project(Vector& x) const;
  /// e = T̃ ẽ. Not collective.
  [[nodiscard]] Eigen::VectorXd normalized(const Eigen::VectorXd& kernelLoad) const;
  /// The motion α = T̃ᵀμ of the clusters that μ stands for: Gᵀμ = G̃ᵀα. Not collective.
  [[nodiscard]] Eigen::VectorXd motionOf(std::span<const double> mu) const;
  /// T̃⁻¹e, what `normalized` makes e of. Not collective.
  void resultantOf(std::span<const double> e, Eigen::VectorXd& kernelLoad) const;
  /// T̃⁻ᵀα, what `motionOf` makes α of. Not collective.
  void multiplierOf(const Eigen::VectorXd& motion, std::span<double> mu) const;
  /// λ̃ = Gᵀe, the shortest λ with Gλ = e. Not collective.
  void feasiblePoint(const Eigen::VectorXd& e, Vector& lambda) const;

private:
  RCP<const Comm> comm_;
  std::vector<KernelEntry> entries_;
  std::shared_ptr<const KernelGram> gram_;
  KernelGram::Matrix lower_;                       ///< L
  Eigen::PermutationMatrix<Eigen::Dynamic> order_; ///< Π
  std::optional<std::vector<int>> anchors_;        ///< see ClusterFaceInverse.hpp
  mutable std::vector<AccurateSum> sums_;
  mutable Eigen::VectorXd work_, product_;
};

} // namespace epafi::fetidp
