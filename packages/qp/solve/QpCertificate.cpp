// What QpSolver says of the point where the iteration ended.

#include "epafi/base/Collective.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/qp/constraints/EqualityRestoration.hpp"
#include "epafi/qp/solve/QpRun.hpp"
#include "epafi/qp/solve/RecessionDirection.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace epafi::qp {

/// An iteration that ended without success far away from where it began may have followed a direction without
/// end; and the direction in which MPRGP met no curvature still holds noise.
void QpSolver::Run::lookForUnboundedness() {
  SolveReport& report = solution.report;
  const bool isFarAway = program.operatorNorm * accurateNorm(x) > 1e3 * accurateNorm(*given.linearTerm);
  const bool hasFailed = report.status == Status::stagnated || report.status == Status::maxIterations;
  if (report.status != Status::unbounded && !(hasFailed && isFarAway))
    return;
  const RecessionDirection found =
      findRecessionDirection(given.hessian, program.operatorNorm, *given.linearTerm, *program.set,
                             program.equality, solver.methods_.mprgp.maxMultiplications);
  report.counts.hessianMultiplications += found.multiplications;
  if (found.direction.is_null())
    return;
  report.certificate = found.direction;
  end(Status::unbounded, explain(Status::unbounded));
}

/// x = Pμ + U(UᵀAU)⁻¹Uᵀb from what solves the deflated problem.
void QpSolver::Run::undoDeflation() {
  deflated->space().project(x);
  deflated->space().correct(*given.linearTerm, x);
  if (const RCP<Vector> certificate = solution.report.certificate; !certificate.is_null()) { // found for PᵀAP
    deflated->space().project(*certificate);
    certificate->scale(1.0 / certificate->norm2());
  }
}

/// g = Ax − b + Bᵀμ, from a product with A if what the iteration holds is of another operator, or not fresh.
void QpSolver::Run::completeGradient() {
  SolveReport& report = solution.report;
  if (deflated.is_null() && program.equality.is_null() && !report.gradient.is_null())
    return;
  const RCP<const Vector> ofLagrangian = report.gradient;
  report.gradient = rcp(new Vector(x.getMap()));
  Vector& gradient = *report.gradient;
  given.hessian->apply(x, gradient);
  ++report.counts.hessianMultiplications;
  gradient.update(-1.0, *given.linearTerm, 1.0);
  report.objective = 0.5 * (accurateDot(x, gradient) - accurateDot(x, *given.linearTerm));
  if (program.equality.is_null())
    return;
  if (report.multiplier.empty() && program.equality->isReplicated())
    completeMultiplier(ofLagrangian.is_null() ? nullptr : ofLagrangian.get());
  program.equality->addTransposedProduct(report.multiplier, 1.0, gradient);
}

/// μ where active sets, which leave it out, have ended: from their gradient, or else what suits x best.
/// Precondition: the report's gradient is Ax − b; the rows are replicated.
void QpSolver::Run::completeMultiplier(const Vector* ofLagrangian) {
  const EqualityConstraint& b = *program.equality;
  std::vector<double>& multiplier = solution.report.multiplier;
  const Vector& gradient = *solution.report.gradient;
  if (ofLagrangian == nullptr) {
    multiplier = estimateMultiplier(b, *program.set, x, gradient);
    return;
  }
  Vector forces(*ofLagrangian, Teuchos::Copy); // Bᵀμ
  forces.update(-1.0, gradient, 1.0);
  std::vector<double> products(b.numEntries());
  b.product(forces, products);
  multiplier.resize(products.size());
  b.weigh(products, multiplier);
}

/// The residuals of bounds, and their multipliers.
void QpSolver::Run::certifyBounds() {
  SolveReport& report = solution.report;
  const Vector& gradient = *report.gradient;
  const GradientSums mine = program.set->measure(x, gradient, gradient, 1.0);
  std::array<AccurateSum, 2> sums{mine.freeSquared, mine.choppedSquared};
  const Comm& comm = *x.getMap()->getComm();
  sumOverRanks(comm, std::span<AccurateSum>(sums));
  report.kkt.stationarity = relativeTo(reference, std::sqrt(sums[0].value()));
  report.kkt.dualFeasibility = relativeTo(reference, std::sqrt(sums[1].value()));
  report.relativeProjectedGradient = std::hypot(report.kkt.stationarity, report.kkt.dualFeasibility);
  report.kkt.complementarity = relativeTo(
      reference, maxOverRanks(comm, program.set->complementarity(x, gradient, program.operatorNorm)));
  Vector work(x, Teuchos::Copy); // the nearest feasible point, then what is free
  program.set->project(work);
  work.update(-1.0, x, 1.0);
  report.kkt.feasibility = work.normInf();

  program.set->freeIndicator(x, work);
  solution.boundMultiplier = rcp(new Vector(gradient, Teuchos::Copy));
  solution.boundMultiplier->elementWiseMultiply(-1.0, work, gradient, 1.0);
}

/// Likewise of the rows of B.
void QpSolver::Run::certifyRows() {
  Vector residual(given.constraintMatrix->getRangeMap());
  given.constraintMatrix->apply(x, residual);
  double size = rows.norm * accurateNorm(x);
  if (!given.constraintValues.is_null()) {
    residual.update(-1.0, *given.constraintValues, 1.0);
    size += accurateNorm(*given.constraintValues);
  }
  solution.report.kkt.equality = relativeTo(size, accurateNorm(residual));
  solution.equalityMultiplier = rows.multiplierOfRows
                                    ? rows.multiplierOfRows(solution.report.multiplier)
                                    : rcp(new Vector(given.constraintMatrix->getRangeMap()));
}

/// The residuals decide, not the doubts on the way.
void QpSolver::Run::judge() {
  SolveReport& report = solution.report;
  const double slack = deflated.is_null() ? 1.0000001 : 10; // the deflated problem has a round-off of its own
  const double limit = slack * std::max(solver.tolerance_, relativeTo(reference, solver.absoluteTolerance_));
  const double gradient = report.relativeProjectedGradient;
  if (report.status == Status::stagnated && gradient <= limit &&
      report.relativeConstraintResidual <= solver.constraintTolerance_)
    end(Status::converged, explain(Status::converged));
  if (report.status == Status::converged &&
      (gradient > limit || report.kkt.equality > std::max(10 * solver.constraintTolerance_, 1e-9)))
    end(Status::stagnated,
        "the iteration met the tolerance, but recomputed from the solution the projected gradient is " +
            text(gradient) + " and the equality residual " + text(report.kkt.equality) +
            " (relative): round-off allows no better");
}

/// The KKT residuals from scratch, the multipliers, and a second look at the status.
void QpSolver::Run::certify() {
  solution.report.counts.hessianMultiplications += extraMultiplications;
  if (!deflated.is_null())
    undoDeflation();
  completeGradient();
  certifyBounds();
  if (!given.constraintMatrix.is_null())
    certifyRows();
  else if (!program.equality.is_null())
    solution.report.kkt.equality = solution.report.relativeConstraintResidual;
  judge();
}

} // namespace epafi::qp
