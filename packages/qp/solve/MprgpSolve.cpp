#include "epafi/qp/solve/MprgpSolve.hpp"

#include "epafi/qp/solve/ErrorTarget.hpp"

#include <optional>

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

SolveReport solveByMprgp(const QuadraticProgram& program, Vector& x, const Tolerances& tolerances,
                         const MprgpParameters& parameters, Observer* observer) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  Mprgp solver(program.hessian, program.set, parameters, program.operatorNorm, program.preconditioner);
  solver.start(*program.linearTerm, x);
  std::optional<ErrorRule> error;
  GradientRule gradient(tolerances.gradientLimit(), tolerances.gradientReference);
  if (tolerances.error != nullptr)
    error.emplace(*tolerances.error, tolerances.gradientReference);
  report.status = runToCertificate(solver, error ? static_cast<StoppingRule&>(*error) : gradient, &recorder);
  x.assign(solver.solution());
  describeEnd(solver, report);
  report.relativeProjectedGradient = relativeTo(tolerances.gradientReference, solver.projectedGradient());
  return report;
}

} // namespace epafi::qp
