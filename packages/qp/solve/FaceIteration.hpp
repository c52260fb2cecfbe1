#pragma once

/// Conjugate gradients on a face, as if it had no bounds: min ½xᵀAx − bᵀx over what may move, Bx = c held
/// exactly. Along a circle the face is its tangent, and the objective that of Newton's method for the circle:
/// ½(x − x0)ᵀK(x − x0) more, K = κttᵀ (Face.hpp). Where entries follow bounds that grow with others, the
/// Hessian Z(A + K)T is not symmetric, and it is GCR with all directions kept (Eisenstat, Elman, Schultz,
/// *SIAM J. Numer. Anal.* 20 (1983)).

#include "epafi/qp/constraints/FaceEquality.hpp"
#include "epafi/qp/solve/Interruption.hpp"
#include "epafi/qp/solve/ScaledObjective.hpp"

#include <optional>
#include <span>
#include <vector>

namespace epafi::qp {

/// The point x, and the gradient g = Ax − b + Bᵀμ of the Lagrangian with the μ that makes it shortest on the
/// face, scaled by 1/‖A‖ (ScaledObjective.hpp); g is known off the face too, where it is the bounds'
/// multiplier. Along tangents it is g + K(x − x0). Z, P_F: FaceEquality.hpp.
class FaceIteration {
public:
  /// Keeps references to objective, interruption and counts. \param m  M ≈ A⁻¹ or null
  FaceIteration(ScaledObjective& objective, RCP<const Operator> m,
                const RCP<const ReplicatedEquality>& equality, const Interruption& interruption,
                StepCounts& counts);

  Vector x;  ///< the point; of the caller until `enter`
  Face face; ///< where it may move; likewise. `enter` gives its tangents their curvature

  /// Where x is on entering a face: at 0, where steps have left it, or elsewhere.
  enum class Point { origin, reached, elsewhere };
  /// x moves onto Bx = c within the face, and g is computed afresh, by one product; none at the origin, or
  /// where x was reached: it is on Bx = c, and g is that of the last step. Nothing may be bent then, and the
  /// last face has to be part of this one but for entries that are at bounds. Collective.
  void enter(Point point = Point::elsewhere);
  /// One step. One product, one application of M, two messages; where something follows two more, five more
  /// with rows. Returns why there can be none: unbounded where there is no curvature, since the face has no
  /// minimum or round-off allows no better one. Collective.
  std::optional<Status> step();

  /// Bᵀν of a ν with B_Fᵀν = 0 along which what of Bx − c the face cannot take away, found on entering it, is
  /// largest: μ + tν leaves g on the face as it is. Two messages of k numbers. Collective.
  void unbalanced(Vector& change);

  /// The direction of the last step, against which x moves where its slope is positive.
  [[nodiscard]] const Vector& direction() const { return p_; }
  [[nodiscard]] double slope() const { return slope_; }       ///< gᵀ of it
  [[nodiscard]] const Vector& gradient() const { return g_; } ///< g
  /// g without K(x − x0); until the next step.
  [[nodiscard]] const Vector& plainGradient();
  /// That of A in an entry, about, scaled: from what M does, or ‖A‖ where it does not tell.
  [[nodiscard]] double stiffness() const { return stiffness_ > 0 ? stiffness_ : objective_.norm(); }
  [[nodiscard]] double gradientNorm() const { return gradient_; } ///< ‖Zg‖
  [[nodiscard]] double energy() const { return energy_; }         ///< gᵀZ P_F M P_F Zg
  [[nodiscard]] double objective() const { return f_; }           ///< f, scaled
  [[nodiscard]] double constraintResidual() const {
    return residual_;
  } ///< ‖Bx − c‖ where the face was entered
  /// What an observer or the clock asked for, on any rank, when the last step was made.
  [[nodiscard]] std::optional<Status> wish() const { return wish_; }
  [[nodiscard]] bool isLookWanted() const { return isLookWanted_; } ///< likewise

private:
  /// The sums of a step, before those of B's rows: three products, what follows and is bent, and who wants
  /// what.
  enum Sums : int {
    first,
    second,
    third,
    tangentEnergy,
    alongTangents,
    following,
    bent,
    timeIsUp,
    interrupted,
    look,
    numOwnSums
  };
  std::optional<Status> conjugateStep();
  std::optional<Status> followingStep();
  void moveOntoEquality();
  void computeGradient(bool isOrigin);
  void makeFollowingDirection();
  void precondition();
  void applyPreconditioner();
  [[nodiscard]] std::span<AccurateSum> rowSums() {
    return reduction_.sums().subspan(numOwnSums, rows_.size());
  }

  ScaledObjective& objective_;
  RCP<const Operator> m_;
  FaceEquality equality_;
  const Interruption& interruption_;
  StepCounts& counts_;
  Vector g_, r_, z_; ///< r: Zg or another masked vector; z = P_F M Zg
  Vector p_, image_; ///< direction and A times it
  FusedReduction reduction_;
  std::vector<double> rows_, multiplier_; ///< work, k
  std::vector<double> missing_;           ///< Bx − c where the face was entered, k
  double f_ = 0, gradient_ = 0, energy_ = 0, residual_ = 0;
  /// rᵀMr/rᵀr of the last r, along tangents where there are some, not scaled; 0 before the first.
  double inverseStiffness_ = 0;
  double stiffness_ = 0;  ///< about that of A along tangents, scaled; 0 where it is not known
  double timesImage_ = 0; ///< zᵀAp
  double slope_ = 0;      ///< gᵀp
  double curvature_ = 0;  ///< pᵀAp of the last step; 0: there was none on this face
  /// Of the face so far, where something follows: p, Ap − Bᵀη, and ‖ZAp‖².
  struct Kept {
    Vector direction, image;
    double squared = 0;
  };
  std::vector<Kept> kept_;
  std::size_t numKept_ = 0;
  std::vector<AccurateSum> sums_; ///< work, numKept_
  int numIdle_ = 0;               ///< steps in a row that have hardly changed ‖Zg‖
  bool hasFollowers_ = false;     ///< on any rank
  std::optional<Status> wish_;
  bool isLookWanted_ = false;
};

} // namespace epafi::qp
