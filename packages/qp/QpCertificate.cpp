// What QpSolver says of the point where the iteration ended.

#include "epafi/base/Collective.hpp"
#include "epafi/qp/QpRun.hpp"
#include "epafi/qp/RecessionDirection.hpp"
#include "epafi/qp/StoppingRule.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace epafi::qp {

/// An iteration that ended without success far away from where it began may have followed a direction without end; and
/// the direction in which MPRGP met no curvature still holds noise.
void QpSolver::Run::lookForUnboundedness() {
  SolveReport& report = solution.report;
  const bool isFarAway = operatorNorm * accurateNorm(x) > 1e3 * accurateNorm(*given.linearTerm);
  const bool hasFailed = report.status == Status::stagnated || report.status == Status::maxIterations;
  if (report.status != Status::unbounded && !(hasFailed && isFarAway))
    return;
  const RecessionDirection found =
      findRecessionDirection(given.hessian, operatorNorm, *given.linearTerm, *set, equality.constraint,
                             solver.mprgp_.maxMultiplications);
  report.counts.hessianMultiplications += found.multiplications;
  if (found.direction.is_null())
    return;
  report.certificate = found.direction;
  end(Status::unbounded, explain(Status::unbounded));
}

/// The KKT residuals from scratch, the multipliers, and a second look at the status.
void QpSolver::Run::certify() {
  SolveReport& report = solution.report;
  report.counts.hessianMultiplications += extraMultiplications;
  Vector gradient(x.getMap());
  if (projector) {
    projector->complete(*given.linearTerm, x);
    if (!report.certificate.is_null()) { // found for AP = PᵀAP
      projector->project(*report.certificate);
      report.certificate->scale(1.0 / report.certificate->norm2());
    }
  }
  if (projector || !equality.constraint.is_null() || report.gradient.is_null()) {
    given.hessian->apply(x, gradient); // what the iteration holds is of another operator, or not fresh
    ++report.counts.hessianMultiplications;
    gradient.update(-1.0, *given.linearTerm, 1.0);
    report.objective = 0.5 * (accurateDot(x, gradient) - accurateDot(x, *given.linearTerm));
    if (!equality.constraint.is_null())
      equality.constraint->addTransposedProduct(multiplier, 1.0, gradient);
    report.gradient = rcp(new Vector(gradient, Teuchos::Copy));
  } else {
    gradient.assign(*report.gradient);
  }
  const GradientSums mine = set->measure(x, gradient, gradient, 1.0);
  std::array<AccurateSum, 2> sums{mine.freeSquared, mine.choppedSquared};
  const Comm& comm = *x.getMap()->getComm();
  sumOverRanks(comm, std::span<AccurateSum>(sums));
  report.kkt.stationarity = relativeTo(reference, std::sqrt(sums[0].value()));
  report.kkt.dualFeasibility = relativeTo(reference, std::sqrt(sums[1].value()));
  report.kkt.complementarity =
      relativeTo(reference, maxOverRanks(comm, set->complementarity(x, gradient, operatorNorm)));
  Vector nearest(x, Teuchos::Copy);
  set->project(nearest);
  nearest.update(-1.0, x, 1.0);
  report.kkt.feasibility = nearest.normInf();

  solution.boundMultiplier = rcp(new Vector(x.getMap()));
  set->freeIndicator(x, nearest);
  solution.boundMultiplier->update(1.0, gradient, 0.0);
  solution.boundMultiplier->elementWiseMultiply(-1.0, nearest, gradient, 1.0);
  if (!given.constraintMatrix.is_null()) {
    Vector residual(given.constraintMatrix->getRangeMap());
    given.constraintMatrix->apply(x, residual);
    double size = equality.norm * accurateNorm(x);
    if (!given.constraintValues.is_null()) {
      residual.update(-1.0, *given.constraintValues, 1.0);
      size += accurateNorm(*given.constraintValues);
    }
    report.kkt.equality = relativeTo(size, accurateNorm(residual));
    solution.equalityMultiplier = equality.multiplierOfRows
                                      ? equality.multiplierOfRows(multiplier)
                                      : rcp(new Vector(given.constraintMatrix->getRangeMap()));
  }
  const double limit = std::max(solver.tolerance_, relativeTo(reference, solver.absoluteTolerance_));
  const double gradientNorm = std::hypot(report.kkt.stationarity, report.kkt.dualFeasibility);
  const double slack = projector ? 10 : 1.0000001; // the projected problem has a round-off of its own
  report.relativeProjectedGradient = gradientNorm;
  const bool meetsGradient = gradientNorm <= slack * limit;
  if (report.status == Status::stagnated && meetsGradient &&
      report.relativeConstraintResidual <=
          solver.constraintTolerance_) // the residuals decide, not the doubts on the way
    end(Status::converged, explain(Status::converged));
  if (report.status == Status::converged &&
      (gradientNorm > slack * limit ||
       report.kkt.equality > std::max(10 * solver.constraintTolerance_, 1e-9))) {
    report.status = Status::stagnated;
    std::ostringstream text;
    text << "the iteration met the tolerance, but recomputed from the solution the projected gradient is "
         << gradientNorm << " and the equality residual " << report.kkt.equality
         << " (relative): round-off allows no better";
    report.reason = text.str();
  }
}

} // namespace epafi::qp
