#pragma once

/// Equilibrium of the floating clusters of subdomains, most often whole bodies: G̃λ = ẽ
/// (KernelConstraint.hpp), a row a motion. The paper's G = T̃G̃ with GGᵀ = I is not formed: what it is needed
/// for is
///   Q = GᵀG = G̃ᵀN⁻¹G̃, P = I − Q, ‖G̃λ − ẽ‖ = ‖Gλ − e‖ in the metric of N⁻¹, N = G̃G̃ᵀ (GramInverse.hpp),
/// and multipliers of G̃'s rows are the motions α of the clusters: G̃ᵀα.

#include "epafi/fetidp/equilibrium/GramInverse.hpp"
#include "epafi/fetidp/equilibrium/KernelGram.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <vector>

namespace epafi::fetidp {

struct ContactStiffness;

/// B = G̃, W = N⁻¹; ẽ is left to the caller.
class NaturalCoarseSpace final : public qp::ReplicatedEquality {
public:
  /// \param entries  see kernelConstraint
  /// Precondition: G̃ has full row rank (see Solvability.hpp, which says so in the user's words). Collective.
  /// \throws Error if it has not.
  NaturalCoarseSpace(const decomposition::DecomposedProblem& problem, std::vector<KernelEntry> entries,
                     GramInverse::Form form = GramInverse::Form::automatic);

  [[nodiscard]] int size() const override { return inverse_->size(); }
  void addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const override;
  void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const override;
  void weigh(std::span<const double> r, std::span<double> mu) const override { inverse_->apply(r, mu); }
  [[nodiscard]] std::unique_ptr<qp::FaceInverse> faceInverse(const RCP<const Map>& map) const override;

  using qp::ReplicatedEquality::normOf;
  using qp::ReplicatedEquality::product;
  /// G̃x on every rank, valid until the next call. Collective.
  [[nodiscard]] const Eigen::VectorXd& product(const Vector& x) const;
  /// ‖r‖ in the metric of N⁻¹. Collective.
  [[nodiscard]] double normOf(const Eigen::VectorXd& r) const {
    return normOf(std::span(r.data(), r.size()));
  }
  /// x ← Px = x − G̃ᵀN⁻¹(G̃x). One message of k numbers, and what N⁻¹ takes. Collective.
  void project(Vector& x) const;
  /// λ̃ = G̃ᵀN⁻¹ẽ, the shortest λ with G̃λ = ẽ. Collective.
  void feasiblePoint(const Eigen::VectorXd& resultants, Vector& lambda) const;
  /// Of N⁻¹, on this rank.
  [[nodiscard]] const GramInverse& gramInverse() const { return *inverse_; }

private:
  RCP<const Comm> comm_;
  std::vector<KernelEntry> entries_;
  std::shared_ptr<const GramInverse> inverse_;
  std::shared_ptr<const ContactGram> contactGram_;
  mutable std::shared_ptr<const ContactStiffness> contactStiffness_; ///< of the first face inverse on
  mutable std::vector<AccurateSum> sums_;
  mutable Eigen::VectorXd product_, motion_;
};

} // namespace epafi::fetidp
