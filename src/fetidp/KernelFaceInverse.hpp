#pragma once

/// N_F⁻ of N_F = G̃ZG̃ᵀ on a face: Z = 1 where multipliers may move, 0 elsewhere. Only rows of contact leave faces, and so, with E the n of k modes
/// that contact touches,
///   N_F = N − E D Eᵀ,   D = Σ gᵢgᵢᵀ over the rows off the face (KernelGram.hpp).
/// The Schur complement of N on these modes is S = (EᵀN⁻¹E)⁻¹ = L⁻ᵀL⁻¹, that of N_F is S − D, and
///   N_F⁻ = N⁻¹ + N⁻¹E K EᵀN⁻¹,   K = L⁻ᵀ (W⁻ − I) L⁻¹,   W = I − LᵀDL,
/// W with eigenvalues in [0,1]: 0 for motions that the face leaves free, in which case W⁻ is chosen so that these are at rest at as many modes.
/// Everything else is N's alone, once for all faces.

#include "epafi/fetidp/GramInverse.hpp"
#include "epafi/fetidp/KernelGram.hpp"
#include "epafi/qp/FaceInverse.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace epafi::fetidp {

/// L. n products with N⁻¹. Collective. \throws Error if N is not positive definite.
Eigen::MatrixXd contactFactor(const ContactGram& gram, const GramInverse& inverse);

class KernelFaceInverse final : public qp::FaceInverse {
public:
  /// Shares all. \param lower  see contactFactor
  /// Not collective.
  KernelFaceInverse(std::shared_ptr<const ContactGram> gram, std::shared_ptr<const GramInverse> inverse,
                    std::shared_ptr<const Eigen::MatrixXd> lower);

  /// n³ operations on every rank; one message (ContactGram). Collective.
  void setFace(const Vector& face) override;
  /// Two products with N⁻¹ and one with K, whose rows are spread where those of N⁻¹ are; a product with N⁻¹ where no row has left. Collective.
  void apply(std::span<const double> b, std::span<double> mu) const override;

private:
  std::shared_ptr<const ContactGram> gram_;
  std::shared_ptr<const GramInverse> inverse_;
  std::shared_ptr<const Eigen::MatrixXd> lower_; ///< L
  bool isWhole_ = true;                          ///< D = 0
  RCP<const Comm> comm_;
  std::vector<int> counts_; ///< rows of K that each rank has
  Eigen::MatrixXd change_;  ///< this rank's rows of K, as columns
  mutable std::vector<double> resultant_;
  mutable Eigen::VectorXd atContact_, reaction_,
      share_; ///< work: Eᵀ of a motion; K times it, and this rank's rows of that
};

} // namespace epafi::fetidp
