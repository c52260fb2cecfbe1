#pragma once

/// The equality constraint Bx = c as SMALBE sees it. Residuals r = Bx − c and multipliers μ are spans of the
/// entries that this rank keeps. Residuals are measured by a weight W, symmetric positive definite: ‖r‖ =
/// (rᵀWr)^½, and Wr is what they add to multipliers.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Types.hpp"
#include "epafi/qp/constraints/FaceInverse.hpp"

#include <memory>
#include <span>
#include <vector>

namespace epafi::qp {

class EqualityConstraint {
public:
  virtual ~EqualityConstraint() = default;

  /// Entries of r and μ that this rank keeps.
  [[nodiscard]] virtual std::size_t numEntries() const = 0;
  /// Whether these are all rows, the same on every rank.
  [[nodiscard]] virtual bool isReplicated() const = 0;
  /// Over-estimate of ‖W^½B‖.
  [[nodiscard]] virtual double norm() const = 0;

  /// r = Bx − c in two halves around a sum over the ranks that the caller makes anyway. The first adds this
  /// rank's contributions to `numSums()` sums; all ranks call it together.
  [[nodiscard]] virtual int numSums() const = 0;
  /// \param sums  numSums() of them
  virtual void addLocalSums(const Vector& x, std::span<AccurateSum> sums) const = 0;
  /// The second fills r and Wr, and returns ‖r‖. Precondition: `addLocalSums` was called last with the same
  /// x. Collective.
  virtual double finishResidual(std::span<const AccurateSum> sums, std::span<double> r,
                                std::span<double> weighed) const = 0;

  /// Bx. Collective.
  virtual void product(const Vector& x, std::span<double> bx) const = 0;
  /// y += factor · Bᵀμ. Collective.
  virtual void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const = 0;
  /// Whether c = 0, on all ranks alike.
  [[nodiscard]] virtual bool isHomogeneous() const { return true; }
  /// This rank's entries of c; empty if c = 0.
  [[nodiscard]] virtual std::span<const double> rightHandSide() const { return {}; }
  /// μᵀr over all rows. Collective.
  [[nodiscard]] virtual double dot(std::span<const double> mu, std::span<const double> r) const = 0;
  /// μ = Wr, W = I if nothing else is said. Collective.
  virtual void weigh(std::span<const double> r, std::span<double> mu) const;
  /// ‖r‖. Collective.
  [[nodiscard]] double normOf(std::span<const double> r) const;
};

/// A few rows, known on every rank, with W = (BBᵀ)⁻¹, so that BᵀWB is a projector: I if they are orthonormal.
/// A product takes part in the messages that a solver sends anyway.
class ReplicatedEquality : public EqualityConstraint {
public:
  /// Number of rows.
  [[nodiscard]] virtual int size() const = 0;
  /// Adds this rank's contribution to the product with x; `finishProduct` makes Bx of the sums over the
  /// ranks. All ranks call it together.
  virtual void addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const = 0;
  /// bx = Bx from the sums over the ranks. Both have size() entries. Not collective.
  static void finishProduct(std::span<const AccurateSum> sums, std::span<double> bx);
  /// For faces; by default of orthonormal rows, dense, with k² numbers in a message a face and k³ operations
  /// on every rank. It may keep a reference to this. Collective.
  [[nodiscard]] virtual std::unique_ptr<FaceInverse> faceInverse(const RCP<const Map>& map) const;

  [[nodiscard]] std::size_t numEntries() const final { return static_cast<std::size_t>(size()); }
  [[nodiscard]] bool isReplicated() const final { return true; }
  [[nodiscard]] double norm() const final { return 1; }
  [[nodiscard]] int numSums() const final { return size(); }
  void addLocalSums(const Vector& x, std::span<AccurateSum> sums) const final { addLocalProduct(x, sums); }
  double finishResidual(std::span<const AccurateSum> sums, std::span<double> r,
                        std::span<double> weighed) const final;
  void product(const Vector& x, std::span<double> bx) const final;
  [[nodiscard]] double dot(std::span<const double> mu, std::span<const double> r) const final;

private:
  mutable std::vector<AccurateSum> sums_; ///< work space of `product`
};

} // namespace epafi::qp
