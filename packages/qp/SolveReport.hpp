#pragma once

/// What a solver says when it stops: a status, a reason, counts of steps by kind, and the history of the
/// iteration.

#include <string>
#include <vector>

namespace epafi::qp {

enum class Status {
  converged,
  maxIterations,
  stagnated,
  indefiniteOperator,
  infeasible,
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
  double projectedGradient = 0;   ///< ‖g^P‖ relative to the stopping reference
  double constraintResidual = 0;  ///< ‖Gλ‖ relative to its reference; 0 without equality constraints
  double objective = 0;           ///< value of the function minimised (augmented Lagrangian in SMALBE)
  long long activeBounds = 0;     ///< entries at a bound
  int hessianMultiplications = 0; ///< products with the operator so far
};

using History = std::vector<StepRecord>;

/// Counts of steps by kind.
struct StepCounts {
  int outer = 0;
  int conjugateGradient = 0;
  int expansion = 0;
  int proportioning = 0;
  int hessianMultiplications = 0;
  int preconditionerApplications = 0;
};

struct SolveReport {
  Status status = Status::maxIterations;
  std::string reason; ///< one sentence
  StepCounts counts;
  double relativeProjectedGradient = 0;
  double relativeConstraintResidual = 0;
  double objective = 0;
  History history; ///< every step, in order
};

/// Receives every step of a solver as it happens. Called on all ranks; must not throw.
class Observer {
public:
  virtual ~Observer() = default;
  virtual void step(const StepRecord& record) = 0;
};

} // namespace epafi::qp
