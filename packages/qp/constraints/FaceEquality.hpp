#pragma once

/// Bx = c on a face: on the columns of B where x may move. Rows may depend on each other there.

#include "epafi/base/Types.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"

#include <Tpetra_Vector.hpp>

#include <memory>
#include <span>
#include <vector>

namespace epafi::qp {

/// With Z of the face (Face.hpp), B_F = BZ, and P_F = Z − B_Fᵀ(B_F B_Fᵀ)⁺B_F, the projector onto what moves
/// in the face and leaves Bx as it is. Without rows it is Z.
class FaceEquality {
public:
  /// \param equality  B of k rows; null for none
  FaceEquality(RCP<const ReplicatedEquality> equality, const RCP<const Map>& map);

  /// From now on this is the face; kept by reference. One message, see the rows' face inverse. Collective.
  void setFace(const Face& face);

  [[nodiscard]] int numRows() const { return numRows_; } ///< k
  /// Adds this rank's contributions to Bx. All ranks call it together.
  void addLocalSums(const Vector& x, std::span<AccurateSum> sums) const;
  /// Bx of the sums over the ranks. Not collective.
  void finish(std::span<const AccurateSum> sums, std::span<double> bx) const;
  /// x ← P_F x. One message of k numbers. Collective.
  void project(Vector& x);
  /// μ with B_Fᵀμ nearest to x on the face, one of these if there are several (FaceInverse.hpp); x becomes 0
  /// off the face. Valid until the next call. Likewise.
  [[nodiscard]] std::span<const double> fit(Vector& x);
  /// y −= B_Fᵀ(B_F B_Fᵀ)⁻Bp on the face: what balances p, which may lie off it. One message. Collective.
  void balance(const Vector& p, Vector& y);
  /// μ = (B_F B_Fᵀ)⁻ b. Collective.
  void multiplierOf(std::span<const double> b, std::span<double> mu) const;
  /// y += factor · B_Fᵀμ; y becomes 0 off the face. Not collective.
  void addTransposed(std::span<const double> mu, double factor, Vector& y) const;
  /// y += factor · Bᵀμ, off the face too. Not collective.
  void addWholeTransposed(std::span<const double> mu, double factor, Vector& y) const;
  /// r = Bx − c. Collective.
  void residual(const Vector& x, std::span<double> r) const;
  /// ‖r‖. Collective.
  [[nodiscard]] double normOf(std::span<const double> r) const {
    return numRows_ == 0 ? 0 : equality_->normOf(r);
  }

private:
  RCP<const ReplicatedEquality> equality_;
  int numRows_;
  const Face* face_ = nullptr;
  std::unique_ptr<FaceInverse> inverse_;     ///< (B_F B_Fᵀ)⁻; null without rows
  std::vector<double> product_, multiplier_; ///< work, k
};

} // namespace epafi::qp
