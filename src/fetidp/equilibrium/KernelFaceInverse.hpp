#pragma once

/// N_F⁻ of N_F = G̃ZG̃ᵀ on a face: Z = 1 where multipliers may move, 0 elsewhere. Only rows of contact leave
/// faces, and so, with E the n of k modes that contact touches,
///   N_F = N − E D Eᵀ,   D = Σ gᵢgᵢᵀ over the rows off the face (KernelGram.hpp).
/// The Schur complement of N on these modes is S = (EᵀN⁻¹E)⁻¹, that of N_F is S_F = S − D, and
///   N_F⁻ = N⁻¹ + N⁻¹E K EᵀN⁻¹,   K = S S_F⁻ S − S.
/// S_F is singular where the face leaves motions of bodies free. With A, modes that no motion of a body
/// leaves at rest (its *anchors*), and δ > 0, S_δ = S_F + δAAᵀ is not, and S_F x = b is S_δ x = b + δA y with
/// y = Aᵀx:
///   (I − δAᵀS_δ⁻¹A) y = AᵀS_δ⁻¹ b, singular just where S_F is, to be solved by a pseudo-inverse: anchors of
///   free motions stay at rest
/// (Farhat, Géradin, *Int. J. Numer. Meth. Engng* 41 (1998), for floating subdomains). N⁻¹ and S are the same
/// for all faces. Where few contacts hold many clusters S_F is tiny beside S and the sum cancels: what is
/// lost comes back by iterative refinement, μ += N_F⁻(b − N_F μ).

#include "epafi/fetidp/equilibrium/GramInverse.hpp"
#include "epafi/fetidp/equilibrium/KernelGram.hpp"
#include "epafi/qp/constraints/FaceInverse.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace epafi::fetidp {

/// S on every rank, n × n.
struct ContactStiffness {
  /// n products with N⁻¹. Collective. \throws Error if N is not positive definite.
  ContactStiffness(const ContactGram& gram, const GramInverse& inverse);

  Eigen::MatrixXd matrix;
  Eigen::VectorXd pivots; ///< of its Cholesky factorisation
};

class KernelFaceInverse final : public qp::FaceInverse {
public:
  /// Shares all. Not collective.
  KernelFaceInverse(std::shared_ptr<const ContactGram> gram, std::shared_ptr<const GramInverse> inverse,
                    std::shared_ptr<const ContactStiffness> stiffness);

  /// n³/3 operations on every rank, and if N⁻¹ is spread its share of 4n³. One message (ContactGram).
  /// Collective.
  void setFace(const qp::Face& face) override;
  /// Two products with N⁻¹ and one with K, by its rows, which are spread where those of N⁻¹ are, or by the
  /// factor of S_δ; as many for each refinement; a product with N⁻¹ where no row has left. Collective.
  void apply(std::span<const double> b, std::span<double> mu) const override;

private:
  template <class Matrix>
  void solveInPlace(Matrix& x) const;
  void makeRows(const Eigen::MatrixXd& missing, double delta);
  void react() const;
  void applyOnce(std::span<const double> b, std::span<double> mu) const;

  std::shared_ptr<const ContactGram> gram_;
  std::shared_ptr<const GramInverse> inverse_;
  std::shared_ptr<const ContactStiffness> stiffness_; ///< S
  bool isWhole_ = true;                               ///< D = 0
  Eigen::SparseMatrix<double> missing_;               ///< D
  Eigen::MatrixXd lower_;                             ///< Cholesky factor of S_δ
  Eigen::MatrixXd response_, atAnchors_;              ///< δS_δ⁻¹A and (I − δAᵀS_δ⁻¹A)⁺
  int numRefinements_ = 0;
  EvenShares shares_;    ///< of the rows of K, if spread
  Eigen::MatrixXd rows_; ///< if spread, this rank's, as columns
  mutable std::vector<double> resultant_, residual_, correction_;
  mutable Eigen::VectorXd atContact_, reaction_, onFace_, share_,
      held_; ///< work: Eᵀ of a motion, K times it, and on the way
};

} // namespace epafi::fetidp
