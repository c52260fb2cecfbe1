#pragma once

/// MPRGP: modified proportioning with reduced gradient projections, for min ½xᵀAx − bᵀx over a convex set Ω.
/// Dostál, Schöberl, *Comput. Optim. Appl.* 30 (2005) 23–43; Dostál, *Optimal Quadratic Programming
/// Algorithms* (2009), algorithm 5.8. Expansion by projected CG: Kružík, Horák, Čermák, Pospíšil, Pecha,
/// *Adv. Eng. Softw.* 149 (2020); by a prediction of the active set: MprgpActiveSet.cpp. Preconditioning in face: Kružík, Horák, arXiv 2507.00617 (2025).

#include "epafi/base/Types.hpp"
#include "epafi/qp/ConvexSet.hpp"
#include "epafi/qp/FusedReduction.hpp"
#include "epafi/qp/MprgpParameters.hpp"
#include "epafi/qp/ProgressWatch.hpp"
#include "epafi/qp/SolveReport.hpp"
#include "epafi/qp/StoppingRule.hpp"

#include <Teuchos_Describable.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <optional>
#include <span>

namespace Teuchos {
class Time;
} // namespace Teuchos

namespace epafi::qp {

/// The iteration, with its state (x, g, p) kept between runs: SMALBE goes on from where the last run stopped.
///
/// Inside, the objective is divided by ‖A‖ (as estimated at the start), so that gradients have the units of x and no
/// threshold has any: g = (Ax − b)/‖A‖. What the public functions return is in the user's units.
///
/// Costs of a step in products with A, messages (beside those inside A and the preconditioner), and vectors streamed
/// (l and u counted as two):
///   CG             1 product, 2 reductions, 23 vectors read and 3 written
///   expansion      2 products, 3 reductions (its first product found the CG step too long); 1 product and 1 reduction
///                  less where the part of it that fits is large enough; 1 more if the trial raises the objective and
///                  is repeated, or if its length is 'optimal'
///   proportioning  1 product, 2 reductions
/// With a preconditioner: 1 application for each direction, 4 vectors more a CG step; 1 reduction more where a
/// proportioning step may come next (βᵀβ > Γ²φ̃ᵀφ/10). Elsewhere M is applied before it is known that the iteration
/// goes on in the face: one application in vain at the end, and where proportioning comes as a surprise.
///   prediction     1 product a CG step in a face and a round (see MprgpActiveSet.cpp), 10 to 150 in all, 3 reductions each
/// All work vectors are allocated by the constructor, those of predictions before the first of these; none in any other step.
///
/// Preconditions: A symmetric positive semidefinite on the unknowns' map; the preconditioner symmetric positive
/// definite. An operator norm that was estimated too small is corrected as soon as a step shows it.
class Mprgp : public Teuchos::Describable {
public:
  /// \param a               A, n × n; kept, not copied
  /// \param set             Ω; kept
  /// \param operatorNorm    over-estimate of ‖A‖, > 0 unless A = 0
  /// \param preconditioner  M ≈ A⁻¹ on the unknowns' map, restricted to the free set where it is used; null for none
  Mprgp(RCP<const Operator> a, RCP<const ConvexSet> set, const MprgpParameters& parameters,
        double operatorNorm, RCP<const Operator> preconditioner = Teuchos::null);

  /// x becomes the projection of x0, g = Ax − b (no product if that is 0), f = ½xᵀAx − bᵀx + constant. Collective.
  void start(const Vector& b, const Vector& x0, double constant = 0);

  /// Runs until the rule is satisfied. Returns converged, or why it went no further: maxIterations, timeLimit,
  /// interrupted, stagnated, indefiniteOperator, indefinitePreconditioner, unbounded or notFinite. x is feasible and finite in any case.
  /// \param observer  told of every step; may be null
  /// Collective.
  Status run(StoppingRule& rule, Observer* observer);

  /// Recomputes g = Ax − b and f (one product): what round-off has added to the updated gradient is gone.
  /// Collective.
  void refreshGradient();

  /// Subtracts `shift` from b without touching x: g grows by it.
  /// \param objectiveShift  what the objective is to grow by; the part that is not shiftᵀx is a constant of the new
  ///                        objective.
  /// Collective.
  void shiftLinearTerm(const Vector& shift, double objectiveShift);

  /// The operator has changed (a new penalty): g and f are given what they grow by at x, b and the constant of the
  /// objective are given anew. No product. \param operatorNorm  of the changed operator. Collective.
  void changeHessian(const Vector& gradientChange, double objectiveChange, const Vector& b, double constant,
                     double operatorNorm);

  [[nodiscard]] const Vector& solution() const { return x_; } ///< x, the iterate
  /// (Ax − b) · gradientScale(), as updated by the steps.
  [[nodiscard]] const Vector& scaledGradient() const { return g_; }
  [[nodiscard]] double gradientScale() const { return scale_; } ///< 1/‖A‖, as it was given
  /// Norm of the projected gradient ‖g^P‖ at the last step.
  [[nodiscard]] double projectedGradient() const { return projectedGradient_ / scale_; }
  /// The same where the last run began.
  [[nodiscard]] double startGradient() const { return startGradient_ / scale_; }
  [[nodiscard]] double solutionNorm() const { return solutionNorm_; }    ///< ‖x‖
  [[nodiscard]] double objective() const { return objective_ / scale_; } ///< f
  /// Whether g was computed from x, not updated by a step.
  [[nodiscard]] bool gradientIsFresh() const { return gradientIsFresh_; }
  [[nodiscard]] StepCounts& counts() { return counts_; } ///< of all runs
  /// ‖A‖, corrected if need be.
  [[nodiscard]] double operatorNorm() const { return norm_ / scale_; }
  /// After indefiniteOperator or unbounded: the direction d that shows it, of length 1, x + αd being the way down.
  [[nodiscard]] RCP<Vector> certificate() const;

  [[nodiscard]] std::string description() const override;

private:
  /// What one product with p tells.
  struct StepSizes {
    double curvature = 0; ///< pᵀAp
    double slope = 0;     ///< gᵀp
    double squared = 0;   ///< pᵀp
    double feasible = 0;  ///< α_f: largest α with x − αp feasible
  };
  /// A trial point of an expansion against x^½.
  struct Trial {
    double objective = 0;
    double size = 0;     ///< |xᵀAx| + |xᵀb|, against which round-off counts
    double squared = 0;  ///< dᵀd of d = x − x^½
    double gradient = 0; ///< dᵀφ(x^½)
  };

  // The loop's questions.
  std::optional<Status> ending(StoppingRule& rule);
  [[nodiscard]] bool isProportional() const;
  [[nodiscard]] bool isWellProportional() const;
  [[nodiscard]] std::optional<Status> endingOf(const StepSizes& sizes) const;
  [[nodiscard]] bool fits(const StepSizes& sizes, StepKind intent) const;
  // Its steps.
  std::optional<Status> setDirection(StepKind intent);
  void step(const StepSizes& sizes, StepKind kind);
  std::optional<Status> expansionStep(const StepSizes& sizes, StepKind intent);
  std::optional<Status> safeTrial(Trial trial);
  bool predictActiveSet(StepKind intent, double halfObjective);
  void takeBoundsOff(StepKind intent, bool isFirst);
  bool minimiseOnFace(double& target);
  // Passes over the vectors.
  void applyHessian(const Vector& x, Vector& ax);
  void precondition();
  void addPreconditionedSums(std::span<AccurateSum> sums) const;
  [[nodiscard]] double energyOfGradient();
  StepSizes stepSizes();
  void move(double length, const StepSizes& sizes);
  double expansionLength(const StepSizes& sizes);
  Trial tryAlong(const Vector& direction, double length);
  Trial tryPoint();
  void accept(const Trial& trial);
  void correctNorm(double rayleighQuotient);
  void measure(StoppingRule& rule);
  void record(const StoppingRule& rule, StepKind kind);
  [[nodiscard]] bool timeIsUpHere() const;
  [[nodiscard]] bool isToStopHere() const;

  Observer* observer_ = nullptr; ///< of the present run
  RCP<const Operator> a_, preconditioner_;
  RCP<const ConvexSet> set_;
  MprgpParameters parameters_;
  double proportioningConstant_; ///< Γ
  double sufficientShare_;       ///< of a CG step that meets the boundary
  double scale_;                 ///< 1/‖A‖ as estimated at the start
  double norm_;                  ///< of scale · A: 1 until it is corrected
  RCP<const Comm> comm_;
  RCP<Teuchos::Time> hessianTimer_, preconditionerTimer_;

  Vector x_, b_, g_, p_, ap_;    ///< g scaled, b and Ap not
  RCP<Vector> residual_, z_;     ///< for the preconditioner: φ or φ + β, and M times it
  RCP<Vector> lastX_, lastG_;    ///< for Barzilai–Borwein: after the last expansion
  RCP<Vector> face_, released_;  ///< for predictions: 1 in the face, else 0; β
  RCP<Vector> bestX_, bestG_;    ///< likewise: the best trial point
  FusedReduction stepReduction_; ///< pᵀAp, gᵀp, pᵀp; α_f; also every other pair of sums
  static constexpr int numOwnSums = 11;
  /// φᵀφ, βᵀβ, φ̃ᵀφ, φᵀAp, xᵀx, active entries; ranks whose time is up, that want to stop, to look; rᵀz, zᵀAp; the rule's
  FusedReduction measureReduction_;
  double objective_ = 0, constant_ = 0; ///< f, and what is in it beside ½xᵀAx − bᵀx
  double linearNorm_ = 0;               ///< ‖b‖, scaled
  double projectedGradient_ = 0, startGradient_ = 0;
  double freeSquared_ = 0, choppedSquared_ = 0; ///< φᵀφ, βᵀβ
  double reducedTimesFree_ = 0;                 ///< φ̃ᵀφ
  double directionTimesImage_ = 0;              ///< φᵀAp or zᵀAp, for the next conjugation
  double residualTimesZ_ = 0;                   ///< rᵀz, where z = Mr
  double energyShare_ = 0;  ///< rᵀMr/rᵀr of the last r it was computed for; 0: none yet
  double curvature_ = 0;    ///< pᵀAp of the last step
  double solutionNorm_ = 0; ///< ‖x‖
  long long active_ = 0;
  bool conjugate_ = false;   ///< whether the next direction is made conjugate to p
  bool staysInFace_ = false; ///< the next measurement is to precondition φ
  bool isForeseen_ = false;  ///< z = Mφ is there already
  bool gradientIsFresh_ = false;
  bool isSatisfied_ = false; ///< what the rule says of the present iterate
  bool timeIsUp_ = false, isInterrupted_ = false, isLookedAt_ = false;
  bool predicts_ = false;        ///< whether expansions predict the active set
  int projectionFailures_ = 0;   ///< projected CG steps that raised the objective, bad ones more than once
  int pause_ = 0, failures_ = 0; ///< of predictions: expansions until the next one; failures in a row
  double deadline_ = 0;
  int refreshes_ = 0;
  ProgressWatch progress_{150};
  StepCounts counts_;
};

} // namespace epafi::qp
