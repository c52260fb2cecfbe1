#include "epafi/qp/solve/QpRun.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/Feasibility.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi::qp {
namespace {

/// Throws InputError on all ranks if an entry is NaN or infinite. Collective.
void requireFinite(const Vector& values, const char* name) {
  collectively(*values.getMap()->getComm(), [&] {
    const auto entries = localData(values);
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (!std::isfinite(entries[i])) {
        const GlobalOrdinal index = values.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i));
        throw InputError("entry " + std::to_string(index) + " of " + name + " is " + text(entries[i]) +
                         "; it must be a finite number");
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
  if (!given.constraintMatrix.is_null() && !given.equality.is_null())
    throw InputError("equality constraints are given twice, as a matrix and as rows; leave out one of them");
  if (given.constraintMatrix.is_null() && !given.constraintValues.is_null())
    throw InputError("constraint values are given without a constraint matrix");
  if (!given.coarseSpace.is_null() && !(given.constraintMatrix.is_null() && given.equality.is_null()))
    throw InputError(
        "projector preconditioning is for problems without equality constraints; leave out the coarse space");
  requireFinite(*given.linearTerm, "the linear term");
  requireFinite(x, "the start x");
  if (!given.constraintValues.is_null())
    requireFinite(*given.constraintValues, "the constraint values");
}

bool QpSolver::Run::prepareConstraints() {
  if (given.set.is_null())
    program.set = rcp(new Box());
  if (const std::string emptiness = program.set->emptiness(*x.getMap()); !emptiness.empty())
    return end(Status::infeasible, emptiness);
  if (given.constraintMatrix.is_null())
    return true;
  rows = prepareEquality(given.constraintMatrix, given.constraintValues, solver.maxDenseRows_, solver.norm_);
  program.equality = rows.constraint;
  program.constraintMatrix = Teuchos::null;
  if (rows.contradiction.empty())
    return true;
  solution.report.certificate = rows.certificate;
  return end(Status::infeasible, rows.contradiction);
}

/// A feasible start from the given one: projected, with the guess of the active set, and onto Bx = c where x
/// and the set allow it.
bool QpSolver::Run::findStart() {
  program.set->project(x);
  if (!given.activeGuess.is_null())
    program.set->activate(*given.activeGuess, x);
  if (program.equality.is_null())
    return true;
  const Feasibility feasibility = findFeasiblePoint(program.equality, program.set, x);
  if (feasibility.isFeasible)
    return true;
  if (rows.multiplierOfRows) {
    const RCP<Vector> certificate = rows.multiplierOfRows(feasibility.certificate);
    certificate->scale(1.0 / certificate->norm2());
    solution.report.certificate = certificate;
  }
  return end(Status::infeasible,
             "no x within the bounds satisfies the equality constraints: the nearest one misses them by " +
                 text(feasibility.distance) + " (rows made orthonormal)");
}

bool QpSolver::Run::prepareOperators() {
  if (!given.coarseSpace.is_null())
    deflate();
  if (solver.operatorNorm_ > 0)
    program.operatorNorm = solver.operatorNorm_;
  try {
    if (!(program.operatorNorm > 0))
      program.operatorNorm = estimateNorm(*program.hessian, solver.norm_).norm;
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) { // on all ranks alike
    return end(Status::notFinite, error.what());
  }
  return chooseReference();
}

/// Projector preconditioning: A and b give way to PᵀAP and Pᵀb.
void QpSolver::Run::deflate() {
  requireMap(given.coarseSpace->getMap()->isSameAs(*x.getMap()), "the coarse space");
  Vector free(x.getMap()); // U must vanish where there is a bound
  program.set->distanceToBoundary(x, std::numeric_limits<double>::infinity(), free);
  collectively(*x.getMap()->getComm(), [&] {
    const auto distance = localData(free);
    for (std::size_t k = 0; k < given.coarseSpace->getNumVectors(); ++k) {
      const auto column = given.coarseSpace->getData(k);
      for (std::size_t i = 0; i < distance.size(); ++i) {
        const double value = column[static_cast<Teuchos_Ordinal>(i)];
        if (!std::isfinite(value))
          throw InputError("the coarse space has an entry that is not a finite number");
        if (std::isfinite(distance[i]) && value != 0)
          throw InputError("the coarse space is not 0 in an entry that has a bound; set its rows there to 0");
      }
    }
  });
  ColumnSpace space(given.hessian->getDomainMap());
  space.add(*given.hessian, *given.coarseSpace);
  if (!space.factorize())
    throw InputError("the coarse space is not independent: UᵀAU is not positive definite; leave out columns "
                     "that others combine, or that A maps to zero");
  const RCP<Vector> projected = rcp(new Vector(*given.linearTerm, Teuchos::Copy));
  space.projectTransposed(*projected);
  program.linearTerm = projected;
  deflated = rcp(new DeflatedOperator(given.hessian, std::move(space)));
  program.hessian = deflated;
}

/// What gradients are relative to: ‖b‖; where that is nothing beside the products with A that the bounds and
/// rows force, the gradient at the feasible point nearest to 0. Where 0 is feasible and b = 0, it is the
/// solution.
bool QpSolver::Run::chooseReference() {
  reference = solver.reference_ > 0 ? solver.reference_ : accurateNorm(*given.linearTerm);
  const bool hasRows = !program.equality.is_null();
  double& operatorNorm = program.operatorNorm;
  if (operatorNorm == 0 && hasRows) // a linear objective: ρ and M still need units
    operatorNorm = accurateNorm(x) > 0 ? reference / accurateNorm(x) : reference;
  if (solver.reference_ > 0)
    return true;
  Vector nearest(x.getMap());
  program.set->project(nearest);
  if (hasRows)
    findFeasiblePoint(program.equality, program.set, nearest);
  if (reference > 1e-12 * operatorNorm * accurateNorm(nearest))
    return true;
  if (accurateNorm(nearest) == 0) {
    x.putScalar(0.0);
    return true;
  }
  Vector gradient(x.getMap());
  given.hessian->apply(nearest, gradient);
  ++extraMultiplications;
  reference = std::max(reference, accurateNorm(gradient));
  return true;
}

void QpSolver::Run::iterate() {
  Tolerances tolerances{.gradient = solver.tolerance_,
                        .gradientReference = reference,
                        .constraint = solver.constraintTolerance_,
                        .absolute = solver.absoluteTolerance_};
  if (!program.equality.is_null()) {
    const EqualityConstraint& b = *program.equality;
    const double c = b.isHomogeneous() ? 0.0 : b.normOf(b.rightHandSide()), norm = program.operatorNorm;
    tolerances.constraintReference = c > 0 ? c : norm > 0 ? b.norm() * reference / norm : 0.0;
  }
  // Along circles MPRGP ends steps again and again.
  const Method suiting = program.set->isCurved() ? Method::activeSets : Method::mprgp;
  solution.report =
      qp::solve(program, solver.method_.value_or(suiting), tolerances, solver.methods_, x, observer);
  if (program.setAt)
    program.set = program.setAt(x);
}

} // namespace epafi::qp
