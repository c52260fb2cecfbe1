#include "epafi/qp/solve/Solve.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/constraints/MovingSet.hpp"
#include "epafi/qp/solve/ActiveSets.hpp"
#include "epafi/qp/solve/ConjugateGradient.hpp"
#include "epafi/qp/solve/MprgpSolve.hpp"
#include "epafi/qp/solve/RecessionDirection.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace epafi::qp {
namespace {

constexpr int endless = std::numeric_limits<int>::max();

/// A solve in which one method may go on where another has ended.
class Course {
public:
  /// Keeps references.
  Course(const QuadraticProgram& program, const Tolerances& tolerances, const SolveParameters& parameters,
         Vector& x, Observer* observer)
      : program_(program), tolerances_(tolerances), parameters_(parameters), x_(x), observer_(observer) {}
  SolveReport run(Method method);

private:
  using Step = std::function<SolveReport(const MprgpParameters& limits)>;
  void makeFacePreconditioner();
  void iterate(Method method);
  void goOn(const Step& step, int most = endless);
  void byFaces(const QuadraticProgram& program, const Tolerances& tolerances,
               const ActiveSetParameters& parameters);
  void byMprgp(const QuadraticProgram& program, int most = endless);
  [[nodiscard]] bool isToGoOn() const;
  bool isProvedUnbounded();
  void solveWithin(const QuadraticProgram& given, const Tolerances& tolerances, double& reduction);
  void fixSet(RCP<const ConvexSet> first);

  QuadraticProgram program_;
  const Tolerances& tolerances_;
  const SolveParameters& parameters_;
  Vector& x_;
  Observer* observer_;
  SolveReport report_;
  const double began_ = Teuchos::Time::wallTime(); ///< seconds
};

SolveReport Course::run(Method method) {
  if (!program_.constraintMatrix.is_null())
    throw InputError(
        "the rows of equality constraints are given as a matrix, which QpSolver takes; here they "
        "are to be an EqualityConstraint, the member 'equality'");
  if (method == Method::conjugateGradient) {
    const QuadraticProgram onKernel = program_.onKernel();
    return solveUnconstrained(onKernel.hessian, onKernel.linearTerm, Teuchos::rcpFromRef(x_),
                              tolerances_.gradient, parameters_.mprgp.maxMultiplications, observer_,
                              onKernel.preconditioner);
  }
  if (program_.set.is_null())
    program_.set = rcp(new Box());
  if (program_.facePreconditioner)
    makeFacePreconditioner();
  iterate(method);
  return std::move(report_);
}

void Course::makeFacePreconditioner() {
  program_.set->project(x_);
  Vector free(x_.getMap());
  program_.set->freeIndicator(x_, free);
  program_.preconditioner = program_.facePreconditioner(free);
  if (program_.preconditioner.is_null())
    throw InputError("the function that makes the preconditioner of a face returned null");
  if (!program_.preconditioner->getDomainMap()->isSameAs(*x_.getMap()))
    throw InputError("the preconditioner of the face is not on the domain map of the Hessian");
}

/// The method, and what goes on after it.
void Course::iterate(Method method) {
  const bool hasManyRows = !program_.equality.is_null() && !program_.equality->isReplicated();
  if ((method == Method::mprgp && !program_.setAt) || hasManyRows) {
    const bool givesWay = parameters_.patience > 0 && !hasManyRows;
    byMprgp(program_, givesWay ? parameters_.patience : endless);
    if (!givesWay || !isToGoOn())
      return;
  }
  if (method == Method::fixedPoint && program_.setAt) {
    fixSet(program_.set);
    return;
  }
  std::optional<Vector> all;
  if (parameters_.beginsFree)
    all.emplace(x_.getMap()).putScalar(1.0);
  byFaces(program_, tolerances_, {parameters_.faceReduction, all ? &*all : nullptr});
  const Status status = report_.status;
  if (status == Status::unbounded && isProvedUnbounded())
    return;
  if (status != Status::unbounded && status != Status::stagnated && status != Status::notFinite)
    return;
  if (!program_.setAt)
    return byMprgp(program_);
  fixSet(program_.setAt(x_));
  if (report_.status != Status::stagnated || !isToGoOn())
    return;
  byFaces(program_, tolerances_, {parameters_.faceReduction}); // from there bounds change by little
  if (report_.status == Status::stagnated)
    report_.reason = program_.unsettled;
}

/// Goes on with a method from x; reports, counts and limits run through. Collective.
/// \param most  products of it
void Course::goOn(const Step& step, int most) {
  MprgpParameters limits = parameters_.mprgp;
  limits.maxMultiplications =
      std::max(1, std::min(most, limits.maxMultiplications - report_.counts.hessianMultiplications));
  if (limits.timeLimit > 0)
    limits.timeLimit = std::max(1e-9, limits.timeLimit - (Teuchos::Time::wallTime() - began_));
  SolveReport further = step(limits);
  append(further, report_);
  further.counts = report_.counts;
  further.history = std::move(report_.history);
  report_ = std::move(further);
}

void Course::byFaces(const QuadraticProgram& program, const Tolerances& tolerances,
                     const ActiveSetParameters& parameters) {
  goOn([&](const MprgpParameters& limits) {
    return solveByActiveSets(program, x_, parameters, tolerances, limits, observer_);
  });
}

/// MPRGP, or SMALBE, within Ω.
void Course::byMprgp(const QuadraticProgram& program, int most) {
  const QuadraticProgram onKernel = program.onKernel();
  goOn(
      [&](const MprgpParameters& limits) {
        return onKernel.equality.is_null()
                   ? solveByMprgp(onKernel, x_, tolerances_, limits, observer_)
                   : solveBySmalbe(onKernel, x_, tolerances_, parameters_.smalbe, limits, observer_);
      },
      most);
}

/// Whether another method is to go on: there are products left after one that has used up its own, or that
/// round-off has ended.
bool Course::isToGoOn() const {
  return (report_.status == Status::maxIterations || report_.status == Status::stagnated) &&
         report_.counts.hessianMultiplications < parameters_.mprgp.maxMultiplications;
}

/// Whether there is a direction along which the objective falls without end; it becomes the certificate.
/// Collective.
bool Course::isProvedUnbounded() {
  constexpr int patience = 2000; // products
  const QuadraticProgram onKernel = program_.onKernel();
  const RCP<const ConvexSet> set = program_.setAt ? program_.setAt(x_) : program_.set;
  const int left = parameters_.mprgp.maxMultiplications - report_.counts.hessianMultiplications;
  const RecessionDirection found =
      findRecessionDirection(onKernel.hessian, program_.operatorNorm, *program_.linearTerm, *set,
                             program_.equality, std::min(patience, left));
  report_.counts.hessianMultiplications += found.multiplications;
  report_.certificate = found.direction;
  return !found.direction.is_null();
}

/// One problem of the fixed point, from x. \param reduction  see ActiveSetParameters; out: what was needed
void Course::solveWithin(const QuadraticProgram& given, const Tolerances& tolerances, double& reduction) {
  constexpr double exact = 1e-3;
  byFaces(given, tolerances, {.faceReduction = reduction});
  if (isToGoOn() && reduction > exact) { // small circles are stiff: half a step there leads nowhere
    reduction = exact;
    byFaces(given, tolerances, {.faceReduction = reduction});
  }
  if (isToGoOn() || report_.status == Status::unbounded)
    byMprgp(given);
}

/// Ω(x) as a fixed point of problems with given sets: slower than faces that take the bounds along, but each
/// of them has a solution that is found. \param first  the set of the first of them. Collective.
void Course::fixSet(RCP<const ConvexSet> first) {
  constexpr int maxRounds = 60;
  constexpr double share = 0.1; // of what bounds still move, each problem is solved to, but no rougher again
  const double reference = tolerances_.gradientReference;
  QuadraticProgram given = program_;
  given.setAt = {};
  Tolerances rough = tolerances_;
  double reduction = parameters_.faceReduction, roughest = std::max(1e-2, tolerances_.gradient),
         moved = roughest / share * reference;
  Vector source(x_, Teuchos::Copy); // where bounds come from
  Relaxation relaxation;
  given.set = std::move(first);
  for (int round = 0; round < maxRounds; ++round) {
    if (tolerances_.error == nullptr && reference > 0)
      rough.gradient = std::clamp(share * moved / reference, tolerances_.gradient, roughest);
    roughest = rough.gradient;
    ++report_.counts.fixedPointRounds;
    solveWithin(given, rough, reduction);
    if (report_.status != Status::converged)
      return;
    Vector next(x_, Teuchos::Copy);
    moved = program_.operatorNorm * moveWithBounds(*given.set, *program_.setAt(x_), next);
    if (moved <= tolerances_.gradientLimit() && rough.gradient <= tolerances_.gradient) {
      x_.assign(next);
      return;
    }
    relaxation.step(x_, source);
    const RCP<const ConvexSet> last = given.set;
    given.set = program_.setAt(source);
    moveWithBounds(*last, *given.set, x_); // what slips goes on slipping
  }
  report_.status = Status::stagnated;
  report_.reason = program_.unsettled;
}

} // namespace

SolveReport solve(const QuadraticProgram& program, Method method, const Tolerances& tolerances,
                  const SolveParameters& parameters, Vector& x, Observer* observer) {
  return Course(program, tolerances, parameters, x, observer).run(method);
}

} // namespace epafi::qp
