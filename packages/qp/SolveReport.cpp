#include "epafi/qp/SolveReport.hpp"

namespace epafi::qp {

std::string toString(Status status) {
  switch (status) {
  case Status::converged:
    return "Converged";
  case Status::maxIterations:
    return "MaxIterations";
  case Status::timeLimit:
    return "TimeLimit";
  case Status::interrupted:
    return "Interrupted";
  case Status::stagnated:
    return "Stagnated";
  case Status::indefiniteOperator:
    return "IndefiniteOperator";
  case Status::indefinitePreconditioner:
    return "IndefinitePreconditioner";
  case Status::infeasible:
    return "Infeasible";
  case Status::unbounded:
    return "Unbounded";
  case Status::notUnique:
    return "NotUnique";
  case Status::notFinite:
    return "NotFinite";
  }
  return "Unknown";
}

std::string explain(Status status) {
  switch (status) {
  case Status::converged:
    return "the tolerance is reached, confirmed by a gradient computed afresh";
  case Status::maxIterations:
    return "the limit of operator products was reached before the tolerance; raise 'Maximum Multiplications' "
           "or the tolerance";
  case Status::timeLimit:
    return "the time limit was reached before the tolerance; raise 'Time Limit' or the tolerance";
  case Status::interrupted:
    return "the iteration was asked to stop before the tolerance was reached; it can go on from its last "
           "iterate";
  case Status::stagnated:
    return "round-off allows no smaller residual (attainable accuracy reached); raise the tolerance";
  case Status::indefiniteOperator:
    return "a direction of negative curvature was met: the operator is not positive definite";
  case Status::indefinitePreconditioner:
    return "the preconditioner is not positive definite: rᵀMr ≤ 0 for a residual r on the free set";
  case Status::infeasible:
    return "the constraints contradict each other";
  case Status::unbounded:
    return "the objective falls without end along a direction of zero curvature that no constraint stops";
  case Status::notUnique:
    return "the solution is not unique";
  case Status::notFinite:
    return "the operator returned NaN or infinity";
  }
  return "";
}

void HistoryRecorder::step(const StepRecord& record) {
  history_.push_back(record);
  if (next_ != nullptr)
    next_->step(record);
}

void HistoryRecorder::look(const Vector& x) {
  if (next_ != nullptr)
    next_->look(x);
}

} // namespace epafi::qp
