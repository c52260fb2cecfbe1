#include "epafi/qp/BoundProblem.hpp"

namespace epafi::qp {

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

void describeEnd(Mprgp& solver, SolveReport& report) {
  report.reason = explain(report.status);
  report.counts = solver.counts();
  report.objective = solver.objective();
  report.operatorNorm = solver.operatorNorm();
  if (solver.gradientIsFresh()) {
    report.gradient = rcp(new Vector(solver.scaledGradient(), Teuchos::Copy));
    report.gradient->scale(1.0 / solver.gradientScale());
  }
  if (report.status == Status::indefiniteOperator || report.status == Status::unbounded)
    report.certificate = solver.certificate();
}

SolveReport solveBoundProblem(const BoundProblem& problem, Vector& x, StoppingRule& rule, double reference,
                              const MprgpParameters& parameters, Observer* observer) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  Mprgp solver(problem.hessian, problem.set, parameters, problem.operatorNorm, problem.preconditioner);
  solver.start(*problem.linearTerm, x);
  report.status = runToCertificate(solver, rule, &recorder);
  x.assign(solver.solution());
  describeEnd(solver, report);
  report.relativeProjectedGradient = relativeTo(reference, solver.projectedGradient());
  return report;
}

SolveReport solveBoundProblem(const BoundProblem& problem, Vector& x, const GradientTolerance& tolerance,
                              const MprgpParameters& parameters, Observer* observer) {
  GradientRule rule(tolerance.relative, tolerance.reference, tolerance.absolute);
  return solveBoundProblem(problem, x, rule, tolerance.reference, parameters, observer);
}

} // namespace epafi::qp
