#pragma once

/// MPRGP: modified proportioning with reduced gradient projections, for min ½xᵀAx − bᵀx, l ≤ x ≤ u.
/// Dostál, Schöberl, *Comput. Optim. Appl.* 30 (2005) 23–43; Dostál, *Optimal Quadratic Programming
/// Algorithms* (2009), algorithm 5.8.

#include "epafi/base/Types.hpp"
#include "epafi/qp/Bounds.hpp"
#include "epafi/qp/FusedReduction.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::qp {

struct MprgpParameters {
  double proportioningConstant = 1.0; ///< Γ > 0
  double expansionStep = 1.9;         ///< ᾱ‖A‖, in (0, 2)
  int maxMultiplications = 10000;     ///< products with A at most

  static Teuchos::ParameterList validParameters();
  /// From a validated list.
  static MprgpParameters from(const Teuchos::ParameterList& list);
};

/// Says when an MPRGP run is over. May take part in the reduction that every step makes anyway: `numSums`
/// further numbers are summed over the ranks at no extra message.
class StoppingRule {
public:
  virtual ~StoppingRule() = default;
  [[nodiscard]] virtual int numSums() const { return 0; }
  /// Adds this rank's contributions for the iterate x. Not collective.
  virtual void addLocalSums(const Vector& /*x*/, std::span<AccurateSum> /*sums*/) {}
  /// \param projectedGradient  ‖g^P‖
  /// \param sums               the sums over all ranks
  virtual bool isSatisfied(double projectedGradient, std::span<const AccurateSum> sums) = 0;
  /// Fills the rule's part of the record (relative quantities).
  virtual void describe(StepRecord& record) const = 0;
};

/// The iteration, with its state (x, g, p) kept between runs: SMALBE goes on from where the last run stopped.
///
/// Costs of a step in products with A, messages (beside those inside A), and vectors streamed:
///   CG             1 product, 2 reductions, 15 vectors read and 3 written
///   expansion      2 products, 3 reductions (its first product found the CG step too long)
///   proportioning  1 product, 2 reductions
/// All work vectors are allocated by the constructor, none in a step.
///
/// Preconditions: A symmetric positive semidefinite on the unknowns' map; ᾱ ≤ 2/‖A‖ for the convergence
/// proof. An expansion that raises the objective (the norm was underestimated) is repeated with half of ᾱ.
class Mprgp {
public:
  /// \param a             A, n × n; kept, not copied
  /// \param operatorNorm  over-estimate of ‖A‖, > 0 unless A = 0
  Mprgp(RCP<const Operator> a, Bounds bounds, const MprgpParameters& parameters, double operatorNorm);

  /// x becomes the projection of x0, g = Ax − b (no product if that is 0), f = ½xᵀ(g − b). Collective.
  void start(const Vector& b, const Vector& x0);

  /// Runs until the rule is satisfied. Returns converged, maxIterations, stagnated, indefiniteOperator or notFinite.
  /// \param observer  told of every step; may be null
  /// Collective.
  Status run(StoppingRule& rule, Observer* observer);

  /// Goes on from the projection of x, with g = Ax − b computed afresh (one product). Collective.
  void moveTo(const Vector& x);

  /// Recomputes g = Ax − b and f (one product): what round-off has added to the updated gradient is gone.
  /// Collective.
  void refreshGradient();

  /// Subtracts `shift` from b without touching x: g grows by it.
  /// \param objectiveShift  shiftᵀx.
  /// Collective.
  void shiftLinearTerm(const Vector& shift, double objectiveShift);

  [[nodiscard]] const Vector& solution() const { return x_; }
  /// g = Ax − b, as updated by the steps.
  [[nodiscard]] const Vector& gradient() const { return g_; }
  /// Norm of the projected gradient ‖g^P‖ at the last step.
  [[nodiscard]] double projectedGradient() const { return projectedGradient_; }
  [[nodiscard]] double objective() const { return objective_; }
  [[nodiscard]] bool gradientIsFresh() const { return gradientIsFresh_; }
  [[nodiscard]] StepCounts& counts() { return counts_; }

private:
  struct StepSizes {
    double curvature = 0; ///< pᵀAp
    double slope = 0;     ///< gᵀp
    double feasible = 0;  ///< α_f: largest α with x − αp feasible
  };

  void applyHessian(const Vector& x, Vector& ax);
  StepSizes stepSizes();
  [[nodiscard]] bool isProportional() const;
  void conjugateGradientStep(const StepSizes& sizes, StoppingRule& rule);
  bool expansionStep(const StepSizes& sizes, StoppingRule& rule);
  Status proportioningStep(StoppingRule& rule);
  void move(double step, const StepSizes& sizes);
  void storeHalfStep();
  double projectHalfStep();
  void measure(StoppingRule& rule);
  void setDirectionToFreeGradient(double conjugation);
  void setDirectionToChoppedGradient();
  void record(const StoppingRule& rule, StepKind kind, Observer* observer);

  RCP<const Operator> a_;
  Bounds bounds_;
  MprgpParameters parameters_;
  double stepLength_; ///< ᾱ
  RCP<const Comm> comm_;

  Vector x_, b_, g_, p_, ap_;
  FusedReduction stepReduction_; ///< pᵀAp, gᵀp; α_f
  FusedReduction measureReduction_; ///< φᵀφ, βᵀβ, φ̃ᵀφ, φᵀAp, entries at a bound, the rule's sums
  double objective_ = 0;
  double projectedGradient_ = 0;                ///< ‖g^P‖
  double freeSquared_ = 0, choppedSquared_ = 0; ///< φᵀφ, βᵀβ
  double reducedTimesFree_ = 0;                 ///< φ̃ᵀφ
  double freeTimesImage_ = 0;                   ///< φᵀAp, for the next conjugation
  long long activeBounds_ = 0;
  bool gradientIsFresh_ = false;
  StepCounts counts_;
};

} // namespace epafi::qp
