#pragma once

/// MPRGP: modified proportioning with reduced gradient projections, for min ½xᵀAx − bᵀx over a convex set Ω.
/// Dostál, Schöberl, *Comput. Optim. Appl.* 30 (2005) 23–43; Dostál, *Optimal Quadratic Programming
/// Algorithms* (2009), algorithm 5.8. Expansion by projected CG: Kružík, Horák, Čermák, Pospíšil, Pecha,
/// *Adv. Eng. Softw.* 149 (2020); by a prediction of the active set: ActiveSetPrediction.hpp. Preconditioning
/// in face: Kružík, Horák, arXiv 2507.00617 (2025).

#include "epafi/qp/constraints/ConvexSet.hpp"
#include "epafi/qp/solve/ActiveSetPrediction.hpp"
#include "epafi/qp/solve/MprgpParameters.hpp"
#include "epafi/qp/solve/ProgressWatch.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

#include <Teuchos_Describable.hpp>

#include <memory>
#include <optional>

namespace epafi::qp {

/// The iteration, with its iterate kept between runs: SMALBE goes on from where the last run stopped.
///
/// Inside, the objective is divided by ‖A‖ (ScaledObjective.hpp). What the public functions return is in the
/// user's units.
///
/// Costs of a step in products with A, messages (beside those inside A and the preconditioner), and vectors
/// streamed (l and u counted as two):
///   CG             1 product, 2 reductions, 23 vectors read and 3 written
///   expansion 2 products, 3 reductions (its first product found the CG step too long); 1 product and 1
///   reduction
///                  less where the part of it that fits is large enough; 1 more if the trial raises the
///                  objective and
///                  is repeated
///   proportioning  1 product, 2 reductions
/// With a preconditioner: 1 application for each direction, 4 vectors more a CG step; 1 reduction more where
/// a proportioning step may come next (βᵀβ > Γ²φ̃ᵀφ/10). Elsewhere M is applied before it is known that the
/// iteration goes on in the face: one application in vain at the end, and where proportioning comes as a
/// surprise. Memory: 6 vectors, 2 more with a preconditioner. All are allocated by the constructor, those of
/// predictions before the first of these; none in any other step.
///
/// Preconditions: A symmetric positive semidefinite on the unknowns' map; the preconditioner symmetric
/// positive definite. An operator norm that was estimated too small is corrected as soon as a step shows it.
class Mprgp : public Teuchos::Describable {
public:
  /// \param a               A, n × n; kept, not copied
  /// \param set             Ω; kept
  /// \param operatorNorm    over-estimate of ‖A‖, > 0 unless A = 0
  /// \param preconditioner  M ≈ A⁻¹ on the unknowns' map, restricted to the free set where it is used; null
  /// for none
  Mprgp(RCP<const Operator> a, RCP<const ConvexSet> set, const MprgpParameters& parameters,
        double operatorNorm, RCP<const Operator> preconditioner = Teuchos::null);
  Mprgp(const Mprgp&) = delete;
  Mprgp& operator=(const Mprgp&) = delete;

  /// x becomes the projection of x0, g = Ax − b (no product if that is 0), f = ½xᵀAx − bᵀx + constant.
  /// Collective.
  void start(const Vector& b, const Vector& x0, double constant = 0);

  /// Runs until the rule is satisfied. Returns converged, or why it went no further: maxIterations,
  /// timeLimit, interrupted, stagnated, indefiniteOperator, indefinitePreconditioner, unbounded or notFinite.
  /// x is feasible and finite in any case.
  /// \param observer  told of every step; may be null
  /// Collective.
  Status run(StoppingRule& rule, Observer* observer);

  /// Recomputes g = Ax − b and f (one product): what round-off has added to the updated gradient is gone.
  /// Collective.
  void refreshGradient();

  /// Subtracts `shift` from b without touching x: g grows by it.
  /// \param objectiveShift  what the objective is to grow by; the part that is not shiftᵀx is a constant of
  /// the new objective.
  /// Collective.
  void shiftLinearTerm(const Vector& shift, double objectiveShift);

  /// The operator has changed (a new penalty): g and f are given what they grow by at x, b and the constant
  /// of the objective are given anew. No product. \param operatorNorm of the changed operator. Collective.
  void changeHessian(const Vector& gradientChange, double objectiveChange, const Vector& b, double constant,
                     double operatorNorm);

  [[nodiscard]] const Vector& solution() const { return iterate_.x; } ///< x, the iterate
  /// (Ax − b) · gradientScale(), as updated by the steps.
  [[nodiscard]] const Vector& scaledGradient() const { return iterate_.g; }
  [[nodiscard]] double gradientScale() const { return objective_.scale(); } ///< 1/‖A‖, as it was given
  /// Norm of the projected gradient ‖g^P‖ at the last step.
  [[nodiscard]] double projectedGradient() const { return now_.projectedGradient / objective_.scale(); }
  /// The same where the last run began.
  [[nodiscard]] double startGradient() const { return startGradient_ / objective_.scale(); }
  [[nodiscard]] double solutionNorm() const { return now_.solutionNorm; }            ///< ‖x‖
  [[nodiscard]] double objective() const { return iterate_.f / objective_.scale(); } ///< f
  /// Whether g was computed from x, not updated by a step.
  [[nodiscard]] bool gradientIsFresh() const { return iterate_.isFresh; }
  [[nodiscard]] StepCounts& counts() { return counts_; } ///< of all runs
  /// ‖A‖, corrected if need be.
  [[nodiscard]] double operatorNorm() const { return objective_.norm() / objective_.scale(); }
  /// After indefiniteOperator or unbounded: the direction d that shows it, of length 1, x + αd being the way
  /// down.
  [[nodiscard]] RCP<Vector> certificate() const;

  [[nodiscard]] std::string description() const override;

private:
  /// What is known of the iterate, from one pass and one message.
  struct Measurement {
    double freeSquared = 0, choppedSquared = 0; ///< φᵀφ, βᵀβ
    double reducedTimesFree = 0;                ///< φ̃ᵀφ
    double freeTimesImage = 0;                  ///< φᵀAp, not scaled
    /// Of z = Mφ, where the iteration was expected to stay in the face.
    std::optional<FacePreconditioner::Products> preconditioned;
    double projectedGradient = 0, solutionNorm = 0; ///< ‖g^P‖, ‖x‖
    long long active = 0;
    bool isSatisfied = false; ///< what the rule says
    bool timeIsUp = false, isInterrupted = false, isLookWanted = false;
  };

  // The loop's questions.
  std::optional<Status> ending(StoppingRule& rule, ProgressWatch& progress, int& refreshes);
  [[nodiscard]] bool isProportional(double margin) const;
  [[nodiscard]] std::optional<Status> endingOf(const StepSizes& sizes) const;
  [[nodiscard]] bool fits(const StepSizes& sizes) const;
  // Its steps.
  std::optional<Status> setDirection(StepKind intent);
  std::optional<Status> setPreconditionedDirection(bool isInFace, double negligible);
  void step(const StepSizes& sizes, StepKind kind);
  std::optional<Status> expand(const StepSizes& sizes, StepKind intent);
  std::optional<Status> descend(double length, bool isFixedStep);
  void setFixedDirection();
  void noteRise(double rise, double size);
  void move(double length, const StepSizes& sizes);
  [[nodiscard]] StepSizes stepSizes();
  void measure(StoppingRule& rule, bool staysInFace);
  [[nodiscard]] double energyOfGradient();
  void record(const StoppingRule& rule, StepKind kind);
  [[nodiscard]] double fixedStep() const;
  [[nodiscard]] double conjugation(double timesImage) const;
  std::unique_ptr<ActiveSetPrediction> makePrediction();

  /// Multipliers no larger, beside ‖g^P‖, release nothing.
  static constexpr double negligibleShare = 1e-12;

  StepCounts counts_;
  MprgpParameters parameters_;
  RCP<const ConvexSet> set_;
  ScaledObjective objective_;
  std::optional<FacePreconditioner> preconditioner_;
  std::unique_ptr<ActiveSetPrediction> prediction_; ///< null as long as none has been wanted
  Interruption interruption_;

  Iterate iterate_;
  StepVectors work_;
  Measurement now_; ///< of the iterate
  FusedReduction measureReduction_;
  /// pᵀAp of the last step, if the next direction in the face is to be conjugate to p.
  std::optional<double> lastCurvature_;
  double energyShare_ = 0; ///< rᵀMr/rᵀr of the last r it was computed for; 0: none yet
  double startGradient_ = 0;
  int stepsInFace_ = 0; ///< of CG, since the face was entered
  /// So many steps, and a preconditioned face is more likely a wrong one, with bounds on what M would have to
  /// move, than a hard one; where Γ is left open.
  int patience_ = 16;
  int projectionFailures_ = 0; ///< projected CG steps that raised the objective, bad ones more than once
};

} // namespace epafi::qp
