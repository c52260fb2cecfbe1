#pragma once

/// What a solver says when it stops: a status, a reason, counts of steps by kind, KKT residuals, a
/// certificate where there is no solution, and the history of the iteration.

#include "epafi/base/Types.hpp"

#include <string>
#include <vector>

namespace epafi::qp {

/// Why a solver stopped.
enum class Status {
  converged,
  maxIterations,
  timeLimit,
  interrupted,        ///< an observer asked for it
  stagnated,          ///< attainable accuracy reached
  indefiniteOperator, ///< a direction of negative curvature was met
  indefinitePreconditioner,
  infeasible,
  unbounded, ///< the objective falls without end
  notUnique,
  notFinite
};

/// "Converged", "MaxIterations", …
std::string toString(Status status);

/// One sentence that says what the status means and what to do.
std::string explain(Status status);

/// Kinds of steps and their letters in every log: c (conjugate gradient), e (expansion), p (proportioning),
/// and s for the start of an inner solve.
enum class StepKind : char { start = 's', conjugateGradient = 'c', expansion = 'e', proportioning = 'p' };

/// One line of the history.
struct StepRecord {
  int iteration = 0; ///< counts from 0 over all outer iterations
  int outer = 0;     ///< outer iteration (SMALBE), 0 for MPRGP alone
  StepKind kind = StepKind::start;
  double projectedGradient = 0;  ///< ‖g^P‖ relative to the stopping reference
  double constraintResidual = 0; ///< ‖Bx − c‖ relative to its reference; 0 without equality constraints
  double objective = 0;          ///< value of the function minimised (augmented Lagrangian in SMALBE)
  long long activeBounds = 0;    ///< entries at a bound
  int hessianMultiplications = 0; ///< products with the operator so far
};

using History = std::vector<StepRecord>; ///< every step, in order

/// Counts of steps by kind.
struct StepCounts {
  int outer = 0;
  int conjugateGradient = 0;
  int expansion = 0;
  int proportioning = 0;
  int hessianMultiplications = 0;
  int preconditionerApplications = 0;
  int safeguards = 0;      ///< expansions repeated because the objective grew
  int normCorrections = 0; ///< times that ‖A‖ turned out to be larger than estimated
  // Of a set Ω(x), signs that its solution may not be the only one:
  int negativeCurvatures = 0; ///< steps on faces that take its bounds along, with pᵀAp < 0
  int fixedPointRounds = 0;   ///< problems with a given Ω that were solved, as such faces did not settle
};

/// The conditions of Karush, Kuhn and Tucker at the point returned, recomputed from scratch. The gradients
/// are those of the Lagrangian, g = Ax − b + Bᵀμ; all are relative: gradients to the stopping reference, Bx −
/// c to its own.
struct KktResiduals {
  double stationarity = 0;    ///< ‖φ‖, the gradient where no bound holds
  double dualFeasibility = 0; ///< ‖β‖, multipliers of bounds that have the wrong sign
  double feasibility = 0;     ///< largest violation of a bound (not relative)
  double complementarity = 0; ///< largest min(|g_i|, ‖A‖ · distance to the bound that −g_i points to)
  double equality = 0;        ///< ‖Bx − c‖
};

struct SolveReport {
  Status status = Status::maxIterations;
  std::string reason; ///< one sentence
  StepCounts counts;
  double relativeProjectedGradient = 0;
  double relativeConstraintResidual = 0;
  double objective = 0;
  double operatorNorm = 0; ///< ‖A‖ as known at the end
  KktResiduals kkt;        ///< filled by QpSolver
  /// Of length 1, or null. indefiniteOperator: d with dᵀAd < 0. unbounded: d with Ad = 0, Bd = 0, dᵀb > 0,
  /// along which the set has no end. infeasible: y on the rows of B with yᵀ(Bx − c) > 0 for every x within
  /// the bounds.
  RCP<Vector> certificate;
  RCP<Vector>
      gradient; ///< of the Lagrangian at x, from a fresh product with A; null if the last one is not fresh
  std::vector<double> multiplier; ///< μ of Bx = c, in the constraint's own entries; from SMALBE alone
  History history;                ///< every step, in order
};

/// Adds the steps of a further solve to a report, its history numbered on. The rest of the report stays as it
/// is.
void append(const SolveReport& further, SolveReport& report);

/// Receives every step of a solver as it happens, and may ask for more. Called on all ranks that have one;
/// must not throw.
class Observer {
public:
  virtual ~Observer() = default;
  /// A step that was made.
  virtual void step(const StepRecord& record) = 0;
  /// Whether this rank wants the iteration to end. Asked at every step; one rank is enough, and all stop at
  /// the same step with the status `interrupted`: the wish travels with the sums that a step makes anyway.
  [[nodiscard]] virtual bool wantsToStop() { return false; }
  /// Whether this rank wants to see the iterate. Likewise; then `look` is called on all ranks that have an
  /// observer.
  [[nodiscard]] virtual bool wantsToLook() { return false; }
  /// The iterate x, on the map of the unknowns; feasible but with CG's, which knows no bounds.
  virtual void look(const Vector& /*x*/) {}
};

/// Keeps every step and passes it on.
class HistoryRecorder final : public Observer {
public:
  /// Keeps references to both; `next` may be null.
  HistoryRecorder(History& history, Observer* next) : history_(history), next_(next) {}
  void step(const StepRecord& record) override;
  [[nodiscard]] bool wantsToStop() override { return next_ != nullptr && next_->wantsToStop(); }
  [[nodiscard]] bool wantsToLook() override { return next_ != nullptr && next_->wantsToLook(); }
  void look(const Vector& x) override;

private:
  History& history_;
  Observer* next_;
};

} // namespace epafi::qp
