#pragma once

/// N⁻ of N = G̃ZG̃ᵀ where there are many clusters, all of it sparse but for the motions of whole bodies. Gluing joins clusters until no more than
/// these are left, m in all, which contact may leave free. With E, m modes of clusters that no motion of a body leaves at rest (its
/// *anchors*), and δ > 0,
///   N_δ = N + δEEᵀ   is positive definite and sparse, and Nx = b is N_δ x = b + δE y with y = Eᵀx:
///   (I − δEᵀN_δ⁻¹E) y = EᵀN_δ⁻¹ b,   m × m and singular just where N is, to be solved by a pseudo-inverse.
/// (Farhat, Géradin, *Int. J. Numer. Meth. Engng* 41 (1998), for floating subdomains.)

#include "epafi/fetidp/KernelGram.hpp"
#include "epafi/qp/FaceInverse.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include <memory>
#include <optional>
#include <vector>

namespace epafi::fetidp {

class NaturalCoarseSpace;

/// Anchors of all floating bodies, modes of clusters; nothing where each body is one cluster, of which all modes would be. Not collective.
std::optional<std::vector<int>> anchorsOf(const decomposition::DecomposedProblem& problem);

class ClusterFaceInverse final : public qp::FaceInverse {
public:
  /// Keeps a reference to the space, and shares the gram. Not collective.
  ClusterFaceInverse(const NaturalCoarseSpace& space, std::shared_ptr<const KernelGram> gram,
                     std::vector<int> anchors);

  /// A sparse factorisation, on every rank; one message (KernelGram). Collective.
  void setFace(const Vector& face) override;
  void apply(std::span<const double> b, std::span<double> mu) const override;

private:
  void solveAtAnchors(double delta);

  const NaturalCoarseSpace& space_;
  std::shared_ptr<const KernelGram> gram_;
  std::vector<int> anchors_;                        ///< E
  Eigen::SimplicialLLT<KernelGram::Matrix> factor_; ///< of N_δ
  bool hasPattern_ = false;
  Eigen::MatrixXd atAnchors_; ///< (I − δEᵀN_δ⁻¹E)⁺
  Eigen::MatrixXd response_;  ///< δN_δ⁻¹E
  mutable Eigen::VectorXd resultant_, permuted_, motion_, work_;
};

} // namespace epafi::fetidp
