#include "epafi/ContactSolver.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/fetidp/Recovery.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace epafi {
namespace {

/// Most memory that this rank's process ever held, in bytes.
double peakBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

double longest(const Comm& comm, double since) {
  return maxOverRanks(comm, Teuchos::Time::wallTime() - since);
}

} // namespace

Teuchos::ParameterList ContactSolver::validParameters() {
  const fetidp::DualParameters dual;
  Teuchos::ParameterList list("Solver");
  addReal(list, "Tolerance", dual.tolerance,
          "The iteration stops when the projected gradient is this small relative to the right-hand side of "
          "the dual problem: ‖d̃‖ if all bodies are supported, ‖Pd‖ with floating bodies.",
          0.0, 1.0, true);
  addReal(list, "Equilibrium Tolerance", dual.equilibriumTolerance,
          "With floating bodies: largest imbalance ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes.",
          0.0, 1.0, true);
  list.sublist("MPRGP").setParameters(qp::MprgpParameters::validParameters());
  list.sublist("SMALBE").setParameters(qp::SmalbeParameters::validParameters());
  list.sublist("Norm Estimate").setParameters(qp::NormEstimateParameters::validParameters());
  fetidp::addFetiParameters(list);
  return list;
}

ContactSolver::ContactSolver(const Teuchos::ParameterList& parameters) {
  const Teuchos::ParameterList list = validated(parameters, validParameters(), "");
  dualParameters_.tolerance = list.get<double>("Tolerance");
  dualParameters_.equilibriumTolerance = list.get<double>("Equilibrium Tolerance");
  dualParameters_.mprgp = qp::MprgpParameters::from(list.sublist("MPRGP"));
  dualParameters_.smalbe = qp::SmalbeParameters::from(list.sublist("SMALBE"));
  dualParameters_.norm = qp::NormEstimateParameters::from(list.sublist("Norm Estimate"));
  dualParameters_.dualOperator = fetidp::dualOperatorFrom(list.sublist("Dual Operator"));
  dualParameters_.preconditioner = fetidp::preconditionerFrom(list.sublist("Preconditioner"));
  directSolvers_ = fetidp::directSolversFrom(list.sublist("Direct Solvers"));
}

void ContactSolver::setup(const decomposition::DecomposedProblem& problem) {
  const double start = Teuchos::Time::wallTime();
  dual_.reset(); // should this setup fail, there is none
  problem_ = &problem;
  inverse_ = std::make_shared<fetidp::GeneralizedInverse>(problem, directSolvers_);
  dual_ = std::make_unique<fetidp::DualProblem>(problem, inverse_, dualParameters_);
  times_ = {};
  times_.setup = longest(*problem.comm, start);
}

fetidp::ContactSolution ContactSolver::solve(const Vector* start, qp::Observer* observer) {
  if (!dual_)
    throw Error("ContactSolver::solve was called before ContactSolver::setup; call setup first");
  const double solveStart = Teuchos::Time::wallTime();
  const fetidp::DualSolution dual = dual_->solve(start, observer);
  report_ = dual.report;
  times_.solve = longest(*problem_->comm, solveStart);

  const double recoveryStart = Teuchos::Time::wallTime();
  fetidp::ContactSolution solution =
      fetidp::recover(*problem_, *inverse_, dual_->kernelEntries(), dual, dual_->norm().norm);
  confirm(solution);
  times_.recovery = longest(*problem_->comm, recoveryStart);
  return solution;
}

/// What the iteration claims must hold for the displacements too: round-off in the subdomain solves can undo it, and
/// a right-hand side that is huge beside the displacements can make it worth little.
void ContactSolver::confirm(const fetidp::ContactSolution& solution) {
  if (report_.status != qp::Status::converged)
    return;
  const double tolerance = dualParameters_.tolerance;
  std::ostringstream reason;
  if (solution.relativeProjectedGradient > 2 * tolerance)
    reason << "recomputed from the solution the projected gradient is " << solution.relativeProjectedGradient;
  else if (solution.feasibility > std::max(1e-3, 1e3 * tolerance))
    reason << "constraints are violated by " << solution.feasibility << " of the largest displacement";
  else
    return;
  report_.status = qp::Status::stagnated;
  report_.reason =
      "the iteration met the tolerance, but " + reason.str() +
      ": round-off in the subdomain solves allows no better; avoid very flat elements and very large "
      "jumps of conductivity, or raise the tolerance";
}

/// How many of the subdomains are multiplied with as dense blocks, and how many different ones there are. Collective.
std::string ContactSolver::describeDualOperator() const {
  if (dual_->algorithm() == fetidp::Algorithm::direct)
    return "none";
  double explicitOnes = 0, different = 0;
  for (const fetidp::SubdomainGroup& group : std::as_const(*inverse_).groups()) {
    different += 1;
    explicitOnes += group.isExplicit() ? static_cast<double>(group.members().size()) : 0.0;
  }
  explicitOnes = sumOverRanks(*problem_->comm, explicitOnes);
  different = sumOverRanks(*problem_->comm, different);
  std::ostringstream text;
  text << (explicitOnes == 0                         ? "implicit"
           : explicitOnes == problem_->numSubdomains ? "explicit"
                                                     : "partly explicit");
  if (explicitOnes > 0 && explicitOnes < problem_->numSubdomains)
    text << " (" << explicitOnes << " of " << problem_->numSubdomains << " subdomains)";
  if (different < problem_->numSubdomains)
    text << ", " << different << " factorisations, the others alike";
  return text.str();
}

Teuchos::ParameterList ContactSolver::reportList(const fetidp::ContactSolution& solution) const {
  const auto& problem = *problem_;
  const Comm& comm = *problem.comm;
  int floating = 0;
  for (const auto& body : problem.bodies)
    floating += body.kernelDimension > 0 ? 1 : 0;

  Teuchos::ParameterList list("Report");
  list.sublist("Problem")
      .set("Primal Dimension", problem.primalDimension)
      .set("Dual Dimension", problem.dualDimension())
      .set("Equality Multipliers", problem.numEqualities)
      .set("Inequality Multipliers", problem.numInequalities)
      .set("Crosspoints", problem.numCrosspoints)
      .set("Subdomains", problem.numSubdomains)
      .set("Floating Bodies", floating)
      .set("Kernel Dimension", problem.kernelDimension)
      .set("Ranks", comm.getSize());
  list.sublist("Algorithm")
      .set("Name", fetidp::toString(dual_->algorithm()))
      .set("Reason", dual_->reason())
      .set("Preconditioner", dual_->preconditioner().is_null()
                                 ? std::string("none")
                                 : fetidp::describe(dualParameters_.preconditioner))
      .set("Dual Operator", describeDualOperator())
      .set("Subdomain Solver", directSolvers_.subdomains)
      .set("Coarse Solver", directSolvers_.coarse)
      .set("Operator Norm", dual_->norm().norm);
  list.sublist("Iterations")
      .set("Outer", report_.counts.outer)
      .set("CG Steps", report_.counts.conjugateGradient)
      .set("Expansion Steps", report_.counts.expansion)
      .set("Proportioning Steps", report_.counts.proportioning)
      .set("Hessian Multiplications", report_.counts.hessianMultiplications)
      .set("Norm Estimate Multiplications", dual_->norm().multiplications)
      .set("Preconditioner Applications", report_.counts.preconditionerApplications);
  list.sublist("Accuracy")
      .set("Relative Projected Gradient", solution.relativeProjectedGradient)
      .set("Feasibility", solution.feasibility)
      .set("Complementarity", solution.complementarity)
      .set("Equilibrium", solution.equilibrium)
      .set("Energy", solution.energy)
      .set("Active Contact Nodes", solution.activeContactNodes)
      .set("Contact Force", solution.contactForce);
  list.sublist("Time").set("Setup", times_.setup).set("Solve", times_.solve).set("Recovery", times_.recovery);
  list.sublist("Memory")
      .set("Peak Bytes", sumOverRanks(comm, peakBytes()))
      .set("Factor Bytes",
           sumOverRanks(comm, static_cast<double>(inverse_->factorBytes() + dual_->preconditionerBytes())));
  list.sublist("Status")
      .set("Converged", report_.status == qp::Status::converged)
      .set("Status", qp::toString(report_.status))
      .set("Reason", report_.reason);
  return list;
}

} // namespace epafi
