#pragma once

/// Preconditioning in face: z = Mr for the part r of the gradient that an iteration follows, z restricted to
/// entries that may move.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/constraints/ConvexSet.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <span>
#include <string>

namespace Teuchos {
class Time;
} // namespace Teuchos

namespace epafi::qp {

/// Two vectors, r and z. Nothing is allocated but by the constructor.
class FacePreconditioner {
public:
  /// What a direction is made of.
  struct Products {
    double energy = 0;     ///< rᵀz
    double timesImage = 0; ///< zᵀw
  };
  static constexpr int numSums = 2; ///< of Products

  /// \param m       M on the map, symmetric positive definite; null for the identity
  /// \param counts  where its applications are counted; kept
  FacePreconditioner(RCP<const Operator> m, const RCP<const Map>& map, StepCounts& counts);

  /// r = φ, z = Mr on the free set.
  void applyToFree(const ConvexSet& set, const Vector& x, const Vector& g);
  /// r = φ + β, z = Mr where the set lets it move.
  void applyToReleased(const ConvexSet& set, const Vector& x, const Vector& g, double negligible);
  /// r = g and z = Mr where `face` is 1, 0 where it is 0.
  void applyInFace(const Vector& face, const Vector& g);
  /// (φ + β)ᵀM(φ + β). Collective, one message.
  double energyOf(const ConvexSet& set, const Vector& x, const Vector& g);

  [[nodiscard]] const Vector& z() const { return z_; } ///< of the last of these
  /// This rank's shares of the products, numSums of them. \param w  any vector
  void addSums(const Vector& w, std::span<AccurateSum> sums) const;
  /// The products, and whether one rank wants to stop; one message. Collective.
  Products products(const Vector& w, bool& isToStop);
  /// Likewise.
  Products products(const Vector& w) {
    bool isToStop = false;
    return products(w, isToStop);
  }

  [[nodiscard]] std::string description() const { return m_->description(); } ///< of M

private:
  void apply();

  RCP<const Operator> m_;
  RCP<Teuchos::Time> timer_;
  StepCounts& counts_;
  Vector r_, z_;
  FusedReduction reduction_;
};

} // namespace epafi::qp
