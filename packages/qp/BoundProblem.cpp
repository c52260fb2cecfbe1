#include "epafi/qp/BoundProblem.hpp"

namespace epafi::qp {

bool RelativeGradientRule::isSatisfied(double projectedGradient, std::span<const AccurateSum> /*sums*/) {
  return projectedGradient <= tolerance_ * reference_;
}

void RelativeGradientRule::describe(StepRecord& record) const {
  record.projectedGradient =
      reference_ > 0 ? record.projectedGradient / reference_ : record.projectedGradient;
}

void HistoryRecorder::step(const StepRecord& record) {
  history_.push_back(record);
  if (next_ != nullptr)
    next_->step(record);
}

Status runToCertificate(Mprgp& solver, StoppingRule& rule, Observer* observer) {
  constexpr int maxFreshStarts = 5;
  for (int freshStarts = 0; freshStarts <= maxFreshStarts; ++freshStarts) {
    const Status status = solver.run(rule, observer);
    if (status != Status::converged || solver.gradientIsFresh())
      return status;
    solver.refreshGradient(); // the next run returns at once if the certificate holds
  }
  return Status::stagnated;
}

SolveReport solveBoundProblem(const RCP<const Operator>& a, const Vector& b, const Bounds& bounds, Vector& x,
                              double tolerance, const MprgpParameters& parameters, double operatorNorm,
                              Observer* observer) {
  bounds.check(*b.getMap()->getComm());
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  const double reference = accurateNorm(b);
  RelativeGradientRule rule(tolerance, reference);
  Mprgp solver(a, bounds, parameters, operatorNorm);
  solver.start(b, x);
  report.status = runToCertificate(solver, rule, &recorder);
  x.assign(solver.solution());

  report.reason = explain(report.status);
  report.counts = solver.counts();
  report.relativeProjectedGradient =
      reference > 0 ? solver.projectedGradient() / reference : solver.projectedGradient();
  report.objective = solver.objective();
  return report;
}

} // namespace epafi::qp
