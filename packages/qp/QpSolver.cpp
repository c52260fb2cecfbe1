#include "epafi/qp/QpSolver.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/Box.hpp"
#include "epafi/qp/ConjugateProjector.hpp"
#include "epafi/qp/Feasibility.hpp"
#include "epafi/qp/LocalData.hpp"
#include "epafi/qp/MatrixEquality.hpp"
#include "epafi/qp/RecessionDirection.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <vector>

namespace epafi::qp {

Teuchos::ParameterList QpSolver::validParameters() {
  Teuchos::ParameterList list("QP");
  addReal(list, "Tolerance", 1e-6, "Stop at ‖gᴾ‖ ≤ Tolerance · Reference.", 0.0, 1.0);
  addReal(list, "Absolute Tolerance", 0.0, "Stop at ‖gᴾ‖ ≤ this as well; 0 leaves the relative test alone.",
          0.0);
  addReal(list, "Reference", 0.0,
          "What ‖gᴾ‖ is relative to; 0 stands for ‖b‖ (or, if b = 0, ‖A‖ times the length of the "
          "feasible point that is nearest to 0).",
          0.0);
  addReal(list, "Constraint Tolerance", 1e-6,
          "Stop only if ‖Bx − c‖ ≤ this times ‖c‖ (or, if c = 0, ‖B‖‖b‖/‖A‖) as well.", 0.0, 1.0, true);
  addInteger(list, "Maximum Dense Rows", 300,
             "Up to so many rows of B are made orthonormal, and redundant ones found, with a dense matrix of "
             "that size on "
             "every rank; beyond, B is only scaled.",
             0);
  addReal(list, "Operator Norm", 0.0,
          "An over-estimate of ‖A‖ if one is known; 0 for an estimate by 'Norm Estimate'.", 0.0);
  list.sublist("MPRGP").setParameters(MprgpParameters::validParameters());
  list.sublist("SMALBE").setParameters(SmalbeParameters::validParameters());
  list.sublist("Norm Estimate").setParameters(NormEstimateParameters::validParameters());
  return list;
}

QpSolver::QpSolver(const Teuchos::ParameterList& parameters) {
  const Teuchos::ParameterList list = validated(parameters, validParameters(), "");
  tolerance_ = list.get<double>("Tolerance");
  absoluteTolerance_ = list.get<double>("Absolute Tolerance");
  reference_ = list.get<double>("Reference");
  constraintTolerance_ = list.get<double>("Constraint Tolerance");
  maxDenseRows_ = list.get<int>("Maximum Dense Rows");
  operatorNorm_ = list.get<double>("Operator Norm");
  mprgp_ = MprgpParameters::from(list.sublist("MPRGP"));
  smalbe_ = SmalbeParameters::from(list.sublist("SMALBE"));
  norm_ = NormEstimateParameters::from(list.sublist("Norm Estimate"));
}

std::string QpSolver::description() const {
  std::ostringstream text;
  text << "Epafi::qp::QpSolver {tolerance: " << tolerance_ << ", last run: " << lastRun_ << "}";
  return text.str();
}

/// One solve, step by step. A step that ends the solve returns false and leaves the status in the report.
struct QpSolver::Run {
  const QpSolver& solver;
  const QuadraticProgram& given;
  Vector& x;
  Observer* observer;
  QpSolution& solution;

  RCP<const ConvexSet> set{};
  RCP<const Operator> hessian{};
  RCP<const Vector> linearTerm{};
  RCP<const Operator> preconditioner{};
  PreparedEquality equality{};
  std::unique_ptr<ConjugateProjector> projector{};
  std::vector<double> multiplier{}; ///< μ of the prepared constraint
  double operatorNorm = 0, reference = 0;

  void check() const;
  bool prepareConstraints();
  bool findStart();
  void prepareOperators();
  void iterate();
  void lookForUnboundedness();
  void certify();

  bool end(Status status, const std::string& reason) const {
    solution.report.status = status;
    solution.report.reason = reason;
    return false;
  }
};

namespace {

/// Throws InputError on all ranks if an entry is NaN or infinite. Collective.
void requireFinite(const Vector& values, const char* name) {
  collectively(*values.getMap()->getComm(), [&] {
    const auto entries = localData(values);
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (!std::isfinite(entries[i])) {
        std::ostringstream text;
        text << "entry " << values.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i)) << " of " << name
             << " is " << entries[i] << "; it must be a finite number";
        throw InputError(text.str());
      }
  });
}

void requireMap(bool fits, const char* name) {
  if (!fits)
    throw InputError(std::string(name) + " is not on the domain map of the Hessian");
}

} // namespace

void QpSolver::Run::check() const {
  if (given.hessian.is_null() || given.linearTerm.is_null())
    throw InputError("a quadratic program needs a Hessian and a linear term; set both members");
  const Map& map = *given.hessian->getDomainMap();
  requireMap(given.linearTerm->getMap()->isSameAs(map), "the linear term");
  requireMap(x.getMap()->isSameAs(map), "the start x");
  requireMap(given.constraintMatrix.is_null() || given.constraintMatrix->getDomainMap()->isSameAs(map),
             "the domain of the constraint matrix");
  requireMap(given.preconditioner.is_null() || given.preconditioner->getDomainMap()->isSameAs(map),
             "the preconditioner");
  requireMap(given.activeGuess.is_null() || given.activeGuess->getMap()->isSameAs(map),
             "the guess of the active set");
  if (given.constraintMatrix.is_null() && !given.constraintValues.is_null())
    throw InputError("constraint values are given without a constraint matrix");
  if (!given.coarseSpace.is_null() && !given.constraintMatrix.is_null())
    throw InputError(
        "projector preconditioning is for problems without equality constraints; leave out the coarse space");
  requireFinite(*given.linearTerm, "the linear term");
  requireFinite(x, "the start x");
  if (!given.constraintValues.is_null())
    requireFinite(*given.constraintValues, "the constraint values");
}

bool QpSolver::Run::prepareConstraints() {
  set = given.set.is_null() ? Teuchos::rcp_implicit_cast<const ConvexSet>(rcp(new Box())) : given.set;
  if (const std::string emptiness = set->emptiness(*x.getMap()); !emptiness.empty())
    return end(Status::infeasible, emptiness);
  if (given.constraintMatrix.is_null())
    return true;
  equality =
      prepareEquality(given.constraintMatrix, given.constraintValues, solver.maxDenseRows_, solver.norm_);
  if (equality.contradiction.empty())
    return true;
  solution.report.certificate = equality.certificate;
  return end(Status::infeasible, equality.contradiction);
}

/// A feasible start from the given one: projected, with the guess of the active set, and onto Bx = c where x and the set
/// allow it.
bool QpSolver::Run::findStart() {
  set->project(x);
  if (!given.activeGuess.is_null())
    set->activate(*given.activeGuess, x);
  if (equality.constraint.is_null())
    return true;
  const Feasibility feasibility = findFeasiblePoint(equality.constraint, set, x);
  if (feasibility.isFeasible)
    return true;
  const RCP<Vector> certificate = equality.multiplierOfRows(feasibility.certificate);
  certificate->scale(1.0 / certificate->norm2());
  solution.report.certificate = certificate;
  std::ostringstream text;
  text << "no x within the bounds satisfies the equality constraints: the nearest one misses them by "
       << feasibility.distance << " (rows made orthonormal)";
  return end(Status::infeasible, text.str());
}

void QpSolver::Run::prepareOperators() {
  hessian = given.hessian;
  linearTerm = given.linearTerm;
  preconditioner = given.preconditioner;
  if (!given.coarseSpace.is_null()) {
    Vector free(x.getMap()), touched(x.getMap()); // U must vanish where there is a bound
    set->distanceToBoundary(x, std::numeric_limits<double>::infinity(), free);
    collectively(*x.getMap()->getComm(), [&] {
      const auto distance = localData(free);
      for (std::size_t k = 0; k < given.coarseSpace->getNumVectors(); ++k) {
        const auto column = given.coarseSpace->getData(k);
        for (std::size_t i = 0; i < distance.size(); ++i)
          if (std::isfinite(distance[i]) && column[static_cast<Teuchos_Ordinal>(i)] != 0)
            throw InputError(
                "the coarse space is not 0 in an entry that has a bound; set its rows there to 0");
      }
    });
    projector = std::make_unique<ConjugateProjector>(given.hessian, given.coarseSpace);
    hessian = projector->projectedOperator();
    const RCP<Vector> projected = rcp(new Vector(x.getMap()));
    projector->projectLinearTerm(*given.linearTerm, *projected);
    linearTerm = projected;
  }
  if (given.facePreconditioner) {
    Vector free(x.getMap());
    set->freeIndicator(x, free);
    preconditioner = given.facePreconditioner(free);
  }
  operatorNorm = solver.operatorNorm_ > 0 ? solver.operatorNorm_ : estimateNorm(*hessian, solver.norm_).norm;
  reference = solver.reference_ > 0 ? solver.reference_ : accurateNorm(*given.linearTerm);
  if (operatorNorm == 0 && !equality.constraint.is_null()) // a linear objective: ρ and M still need units
    operatorNorm = accurateNorm(x) > 0 ? reference / accurateNorm(x) : reference;
  if (reference == 0) {
    Vector nearest(x.getMap());
    set->project(nearest);
    if (!equality.constraint.is_null())
      findFeasiblePoint(equality.constraint, set, nearest);
    reference = operatorNorm * accurateNorm(nearest);
  }
}

void QpSolver::Run::iterate() {
  if (equality.constraint.is_null()) {
    const BoundProblem problem{hessian, linearTerm, set, preconditioner, operatorNorm};
    solution.report = solveBoundProblem(problem, x, {solver.tolerance_, reference, solver.absoluteTolerance_},
                                        solver.mprgp_, observer);
    return;
  }
  const EqualityConstraint& b = *equality.constraint;
  const double c = b.isHomogeneous() ? 0.0 : std::sqrt(b.dot(b.rightHandSide(), b.rightHandSide()));
  SmalbeTolerances tolerances;
  tolerances.gradient =
      reference > 0 ? std::max(solver.tolerance_, solver.absoluteTolerance_ / reference) : 0.0;
  tolerances.gradientReference = reference;
  tolerances.constraint = solver.constraintTolerance_;
  tolerances.constraintReference = c > 0 ? c : operatorNorm > 0 ? b.norm() * reference / operatorNorm : 0.0;
  const EqualityBoundProblem problem{hessian,        linearTerm,  set, equality.constraint,
                                     preconditioner, operatorNorm};
  solution.report =
      solveEqualityBoundProblem(problem, x, multiplier, tolerances, solver.smalbe_, solver.mprgp_, observer);
}

/// An iteration that ended without success far away from where it began may have followed a direction without end.
void QpSolver::Run::lookForUnboundedness() {
  SolveReport& report = solution.report;
  if (report.status != Status::stagnated && report.status != Status::maxIterations)
    return;
  if (operatorNorm * accurateNorm(x) <= 1e3 * accurateNorm(*given.linearTerm))
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
  Vector gradient(x.getMap());
  if (projector)
    projector->complete(*given.linearTerm, x);
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

QpSolution QpSolver::solve(const QuadraticProgram& problem, Vector& x, Observer* observer) {
  const Teuchos::TimeMonitor timing(*Teuchos::TimeMonitor::getNewCounter("Epafi::qp: QpSolver::solve"));
  QpSolution solution;
  Run run{*this, problem, x, observer, solution};
  run.check();
  if (run.prepareConstraints() && run.findStart()) {
    run.prepareOperators();
    run.iterate();
    run.lookForUnboundedness();
    run.certify();
  }
  lastRun_ = toString(solution.report.status);
  lastRun_.append(", ")
      .append(std::to_string(solution.report.counts.hessianMultiplications))
      .append(" products");
  return solution;
}

} // namespace epafi::qp
