#include "epafi/ContactSolver.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/fetidp/equilibrium/ProblemChecks.hpp"
#include "epafi/fetidp/solve/Recovery.hpp"
#include "epafi/qp/solve/BoundFeedback.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace epafi {
namespace {

const std::vector<std::string> algorithms = {"auto", "MPRGP", "active set", "fixed point"};

double longest(const Comm& comm, double since) {
  return maxOverRanks(comm, Teuchos::Time::wallTime() - since);
}

} // namespace

Teuchos::ParameterList ContactSolver::validParameters() {
  const fetidp::Plan plan;
  Teuchos::ParameterList list("Solver");
  addRealOrWord(list, "Tolerance", plan.tolerance, {"balanced"},
                "The iteration stops when the projected gradient is this small relative to the right-hand "
                "side of the dual problem: ‖d̃‖ if all bodies are supported, ‖Pd‖ with floating bodies. "
                "'balanced': when the error that is left of the iteration is the Algebraic Fraction of what "
                "the mesh allows, both estimated in the energy norm; no digit more than the mesh can use.",
                0.0, 1.0);
  addReal(list, "Algebraic Fraction", plan.algebraicFraction,
          "With Tolerance 'balanced': algebraic error as a fraction of the discretisation error. With 0.1 "
          "the two together are half a per cent more than the discretisation error alone.",
          0.0, 1.0, true);
  addReal(list, "Equilibrium Tolerance", fetidp::DualParameters().equilibriumTolerance,
          "With floating bodies: largest imbalance ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes.",
          0.0, 1.0, true);
  addChoice(list, "Algorithm", algorithms.front(),
            "How contact is found. 'MPRGP': the paper's, with SMALBE around it where bodies float; "
            "active sets go on after 300 products. 'active "
            "set': primal-dual active sets with equilibrium held exactly on every face, then MPRGP or SMALBE "
            "from their best "
            "point, should the faces not settle. 'fixed point': with Coulomb's friction problems with given "
            "bounds, each by active sets, until the bounds settle; else active sets. 'auto': active set "
            "where bodies float and there is a preconditioner, and where the driver starts from a coarser "
            "mesh (Accuracy/Coarser Start), else "
            "MPRGP. Without contact there is nothing to choose.",
            algorithms);
  list.sublist("MPRGP").setParameters(qp::MprgpParameters::validParameters());
  list.sublist("SMALBE").setParameters(qp::SmalbeParameters::validParameters());
  list.sublist("Norm Estimate").setParameters(qp::NormEstimateParameters::validParameters());
  fetidp::addFetiParameters(list);
  return list;
}

ContactSolver::ContactSolver(const Teuchos::ParameterList& parameters, const fetidp::RunFacts& run)
    : run_(run) {
  const Teuchos::ParameterList list = validated(parameters, validParameters(), "");
  static_cast<fetidp::FetiParameters&>(dualParameters_) = fetidp::fetiParametersFrom(list);
  dualParameters_.isBalanced = list.isType<std::string>("Tolerance");
  const auto isGiven = [&](const char* name) { return !list.getEntry(name).isDefault(); };
  if (isGiven("Tolerance") && !dualParameters_.isBalanced)
    dualParameters_.tolerance = list.get<double>("Tolerance");
  if (isGiven("Algebraic Fraction"))
    dualParameters_.algebraicFraction = list.get<double>("Algebraic Fraction");
  dualParameters_.equilibriumTolerance = list.get<double>("Equilibrium Tolerance");
  dualParameters_.method = enumeratorFrom<fetidp::DualParameters::Method>(list, "Algorithm", algorithms);
  dualParameters_.mprgp = qp::MprgpParameters::from(list.sublist("MPRGP"));
  dualParameters_.smalbe = qp::SmalbeParameters::from(list.sublist("SMALBE"));
  dualParameters_.norm = qp::NormEstimateParameters::from(list.sublist("Norm Estimate"));
  plan_ = fetidp::plan({.run = run_}, dualParameters_);
}

void ContactSolver::setup(const decomposition::DecomposedProblem& problem,
                          const decomposition::ProblemData& data) {
  problem_ = &problem;
  factorise(data, nullptr);
}

void ContactSolver::update(const decomposition::ProblemData& data) {
  if (!inverse_)
    throw Error("ContactSolver::update was called before ContactSolver::setup; call setup first");
  factorise(data, std::move(inverse_)); // none is left should this fail
}

/// What follows from the matrices. \param earlier  of the same problem, or null
void ContactSolver::factorise(const decomposition::ProblemData& data,
                              std::shared_ptr<fetidp::GeneralizedInverse> earlier) {
  const double start = Teuchos::Time::wallTime();
  dual_.reset(); // should this fail, there is none
  fetidp::requireFiniteMatrices(*problem_);
  fetidp::requireOwnData(*problem_, data);
  fetidp::requireFiniteData(*problem_, data);
  inverse_ = std::make_shared<fetidp::GeneralizedInverse>(*problem_, dualParameters_.directSolvers,
                                                          std::move(earlier));
  dual_ = std::make_unique<fetidp::DualProblem>(*problem_, data, inverse_, dualParameters_, run_);
  times_ = {};
  times_.setup = longest(*problem_->comm, start);
}

fetidp::ContactSolution ContactSolver::solve(const decomposition::ProblemData& data, const Vector* start,
                                             qp::Observer* observer, const fetidp::ErrorBalance* balance) {
  if (!dual_)
    throw Error("ContactSolver::solve was called before ContactSolver::setup; call setup first");
  const double solveStart = Teuchos::Time::wallTime();
  qp::Interruption interruption(dualParameters_.mprgp.timeLimit);
  interruption.setObserver(observer);
  const fetidp::DualSolution dual = dual_->solve(data, start, observer, balance);
  report_ = dual.report;
  times_.solve = longest(*problem_->comm, solveStart);

  const double recoveryStart = Teuchos::Time::wallTime();
  fetidp::ContactSolution solution = fetidp::recover(*dual_, data, dual);
  if (!plan().isBalanced && problem_->numFriction == 0) // what slips has forces of its own
    settle(data, dual, interruption, solution);
  solution.algebraicError = algebraicErrorOf(data, solution);
  confirm(solution, dual.errorTarget);
  if (data.hasCoulombFriction())
    measureFeedback(data, interruption, solution);
  times_.recovery = longest(*problem_->comm, recoveryStart);
  return solution;
}

namespace {

/// gᵀC⁻¹g of the rows that give way, of this rank; they become 0 in g.
double takenBySprings(const Vector& compliance, Vector& gradient) {
  const auto values = compliance.getData();
  const auto rest = gradient.getDataNonConst();
  double sum = 0;
  for (LocalOrdinal i = 0; i < rest.size(); ++i)
    if (values[i] > 0) {
      sum += rest[i] * rest[i] / values[i];
      rest[i] = 0;
    }
  return sum;
}

} // namespace

/// (g^Pᵀ M g^P)^½ of the gradient g = c − Bu: no eigenvalue of MF is below 1, so that it is the algebraic
/// error in the energy norm at most (see qp/StoppingRule.hpp), that of the springs of contacts included.
/// Collective.
double ContactSolver::algebraicErrorOf(const decomposition::ProblemData& data,
                                       const fetidp::ContactSolution& solution) const {
  if (dual_->algorithm() == fetidp::Algorithm::direct)
    return 0;
  if (dual_->preconditioner().is_null())
    return std::numeric_limits<double>::quiet_NaN();
  Vector gradient(solution.slack->getMap()), image(gradient.getMap());
  dual_->feasibleForces(data, *solution.multiplier)
      ->projectedGradient(*solution.multiplier, *solution.slack, 0.0, gradient);
  dual_->preconditioner()->apply(gradient, image);
  const double whole = std::max(0.0, accurateDot(gradient, image));
  if (problem_->compliance.is_null())
    return std::sqrt(whole);
  // (F + C)⁻¹ is no greater than C⁻¹ either: of contacts that give way this is the smaller one.
  const double springs = sumOverRanks(*problem_->comm, takenBySprings(*problem_->compliance, gradient));
  dual_->preconditioner()->apply(gradient, image);
  return std::sqrt(std::min(whole, 2 * (springs + std::max(0.0, accurateDot(gradient, image)))));
}

/// With Coulomb's friction the error of the bounds is one of the solution, too.
void ContactSolver::measureFeedback(const decomposition::ProblemData& data,
                                    const qp::Interruption& interruption,
                                    fetidp::ContactSolution& solution) const {
  if (run_.purpose == fetidp::Purpose::start)
    return;
  solution.frictionFeedback = std::numeric_limits<double>::quiet_NaN();
  if (report_.status != qp::Status::converged) { // T′ tells of solutions
    solution.algebraicError = solution.frictionFeedback;
    return;
  }
  qp::QuadraticProgram program;
  program.hessian = dual_->operators().flexibility();
  program.preconditioner = dual_->operators().facePreconditioner;
  program.equality = dual_->coarseSpace();
  program.setAt = [&](const Vector& lambda) { return dual_->feasibleForces(data, lambda); };
  Vector error(solution.slack->getMap()), gradient(error.getMap()); // with the bounds given, about
  program.setAt(*solution.multiplier)
      ->projectedGradient(*solution.multiplier, *solution.slack, 0.0, gradient);
  if (const RCP<const Operator> m = program.preconditioner; m.is_null() || gradient.normInf() == 0)
    error.update(1.0, gradient.normInf() == 0 ? *solution.multiplier : gradient, 0.0);
  else
    m->apply(gradient, error);
  const qp::BoundFeedback feedback =
      qp::boundFeedback(program, *solution.multiplier, *solution.slack, error, [&] {
        return holdsAnywhere(*problem_->comm, interruption.timeIsUp() || interruption.isWanted());
      });
  solution.frictionFeedback = feedback.factor;
  solution.feedbackMultiplications = feedback.multiplications;
  if (!(feedback.factor < 1)) // or not known
    solution.algebraicError =
        feedback.factor >= 1 ? std::numeric_limits<double>::infinity() : feedback.factor;
  else
    solution.algebraicError *= std::max(feedback.amplification, 1 / (1 - feedback.factor));
}

namespace {

/// What constraints may be violated by, relative to the largest displacement: 1000 tolerances, or what
/// round-off leaves of differences of displacements in the worst of the problems that are solved well.
double allowedViolation(double tolerance) {
  return std::max(1e-7, 1e3 * tolerance);
}

} // namespace

/// ‖d̃‖ can be huge beside the displacements, where a body or a part of it hardly hangs on anything: the
/// tolerance is met long before the constraints are. And round-off may end an iteration that is not far from
/// its tolerance: responses to what is left of the gradient go on from there.
void ContactSolver::settle(const decomposition::ProblemData& data, fetidp::DualSolution dual,
                           const qp::Interruption& interruption, fetidp::ContactSolution& solution) {
  const double tolerance = plan().tolerance, allowed = allowedViolation(tolerance);
  constexpr double roundOff = 1e-13; // of u itself, which rows that are closed to the last digit do not tell
  const bool isRough = solution.relativeProjectedGradient > 2 * std::max(tolerance, solution.roundOff),
             isStagnated = dual.report.status == qp::Status::stagnated;
  if ((isRough || isStagnated) && tolerance < roundOff)
    return;
  if (!isStagnated &&
      !(dual.report.status == qp::Status::converged && (isRough || solution.feasibility > allowed)))
    return;
  dual.report.status = qp::Status::converged; // if this is well with the rest
  const double asked = isRough ? 0.1 * tolerance * dual.reference : 0.0;
  const std::optional<fetidp::ContactSolution> settled =
      fetidp::recoverSettled(*dual_, data, dual, {0.01 * allowed, asked}, report_, interruption);
  if (!settled || report_.status == qp::Status::interrupted || report_.status == qp::Status::timeLimit)
    return;
  if (settled->equilibrium > std::max(2 * dualParameters_.equilibriumTolerance, solution.equilibrium))
    return;
  if (settled->relativeProjectedGradient <= 2 * std::max(tolerance, settled->roundOff) ||
      (!isStagnated && settled->feasibility < solution.feasibility)) {
    solution = *settled;
    report_.status = qp::Status::converged;
    report_.reason =
        isRough ? "the tolerance is reached; the last digits were settled where round-off ended the iteration"
                : dual.report.reason;
  }
}

/// What the iteration claims must hold for the displacements too: round-off in the subdomain solves can undo
/// it, and a right-hand side that is huge beside the displacements can make it worth little.
void ContactSolver::confirm(const fetidp::ContactSolution& solution, double errorTarget) {
  if (report_.status != qp::Status::converged)
    return;
  const double tolerance = plan().tolerance;
  std::ostringstream reason;
  if (plan().isBalanced && solution.algebraicError > 2 * errorTarget)
    reason << "recomputed from the solution the algebraic error is " << solution.algebraicError << ", not "
           << errorTarget;
  else if (!plan().isBalanced &&
           solution.relativeProjectedGradient > 2 * std::max(tolerance, solution.roundOff))
    reason << "recomputed from the solution the projected gradient is " << solution.relativeProjectedGradient;
  else if (!plan().isBalanced && solution.feasibility > allowedViolation(tolerance))
    reason << "constraints are violated by " << solution.feasibility << " of the largest displacement";
  else if (solution.equilibrium > 2 * dualParameters_.equilibriumTolerance)
    reason << "floating bodies are out of balance by " << solution.equilibrium << " of the loads on them";
  if (reason.str().empty()) {
    if (!plan().isBalanced && solution.relativeProjectedGradient > 2 * tolerance)
      report_.reason =
          "the projected gradient is what rounding makes of displacements and gaps; doubles hold no "
          "smaller one";
    return;
  }
  report_.status = qp::Status::stagnated;
  report_.reason = "the iteration met the tolerance, but " + reason.str() +
                   ": round-off in the subdomain solves allows no better; avoid very flat elements and very "
                   "large jumps of conductivity, or raise the tolerance";
}

} // namespace epafi
