#pragma once

/// N_F⁻ of N_F = G̃ZG̃ᵀ on a face: Z = 1 where multipliers may move, 0 elsewhere. Only rows of contact leave faces, and so, with E the n of k modes
/// that contact touches,
///   N_F = N − E D Eᵀ,   D = Σ gᵢgᵢᵀ over the rows off the face (KernelGram.hpp).
/// The Schur complement of N on these modes is S = (EᵀN⁻¹E)⁻¹, that of N_F is S_F = S − D, and
///   N_F⁻ = N⁻¹ + N⁻¹E K EᵀN⁻¹,   K = S S_F⁻ S − S = S S_F⁻¹ D.
/// Where the face leaves motions free S_F is singular: the last form does not hold then, and S_F⁻ is chosen so that these motions are at rest at as
/// many modes. N⁻¹ and S are the same for all faces.

#include "epafi/fetidp/GramInverse.hpp"
#include "epafi/fetidp/KernelGram.hpp"
#include "epafi/qp/FaceInverse.hpp"

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

  /// n³/3 operations on every rank, and its share of 4n³; some 30n³ where motions are free. One message (ContactGram). Collective.
  void setFace(const Vector& face) override;
  /// Two products with N⁻¹ and one with K, whose rows are spread where those of N⁻¹ are; a product with N⁻¹ where no row has left. Collective.
  void apply(std::span<const double> b, std::span<double> mu) const override;

private:
  std::shared_ptr<const ContactGram> gram_;
  std::shared_ptr<const GramInverse> inverse_;
  std::shared_ptr<const ContactStiffness> stiffness_; ///< S
  bool isWhole_ = true;                               ///< D = 0
  std::vector<int> counts_;                           ///< rows of K that each rank has
  int first_;                                         ///< the first of this rank's
  Eigen::MatrixXd change_;                            ///< this rank's rows of K, as columns
  mutable std::vector<double> resultant_;
  /// Work: Eᵀ of a motion; K times it, and this rank's rows of that.
  mutable Eigen::VectorXd atContact_, reaction_, share_;
};

} // namespace epafi::fetidp
