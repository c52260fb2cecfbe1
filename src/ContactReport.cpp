// What ContactSolver says of a solve.

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Version.hpp"

#include <Teuchos_Comm.hpp>

#include <sys/resource.h>

#include <cmath>
#include <sstream>

namespace epafi {
namespace {

/// Most memory that this rank's process ever held, in bytes.
double peakBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

} // namespace

/// How many of the subdomains are multiplied with as dense blocks, and how many different ones there are.
/// Collective.
std::string ContactSolver::describeDualOperator() const {
  if (dual_->algorithm() == fetidp::Algorithm::direct)
    return "none";
  int explicitOnes = 0, different = 0;
  for (const fetidp::SubdomainGroup& group : inverse_->groups()) {
    different += 1;
    explicitOnes += group.isExplicit() ? static_cast<int>(group.members().size()) : 0;
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

int ContactSolver::numAdaptiveConstraints() const {
  return dual_->deflatedOperator().is_null() ? 0 : dual_->deflatedOperator()->space().size();
}

/// "dirichlet, stiffness scaling, 12 adaptive constraints".
std::string ContactSolver::describePreconditioner() const {
  std::ostringstream text;
  text << (dual_->preconditioner().is_null() ? std::string("none")
                                             : fetidp::describe(dualParameters_.preconditioner));
  if (const int number = numAdaptiveConstraints(); number > 0)
    text << ", " << number << (number == 1 ? " adaptive constraint" : " adaptive constraints");
  if (const auto& corrected = dual_->operators().corrected; !corrected.is_null())
    text << ", corrected for " << corrected->space().size() << " jumps of contact";
  return text.str();
}

Teuchos::ParameterList ContactSolver::reportList(const fetidp::ContactSolution& solution) const {
  const auto& problem = *problem_;
  const Comm& comm = *problem.comm;
  int floating = 0;
  for (const auto& body : problem.bodies)
    floating += body.kernelDimension > 0 ? 1 : 0;

  const std::size_t deflated =
      dual_->deflatedOperator().is_null() ? 0 : dual_->deflatedOperator()->space().bytes();
  Teuchos::ParameterList list("Report");
  list.sublist("Epafi").set("Version", std::string(version()));
  list.sublist("Problem")
      .set("Primal Dimension", problem.primalDimension)
      .set("Dual Dimension", problem.dualDimension())
      .set("Equality Multipliers", problem.numEqualities)
      .set("Inequality Multipliers", problem.numInequalities)
      .set("Crosspoints", problem.numCrosspoints)
      .set("Adaptive Constraints", numAdaptiveConstraints())
      .set("Subdomains", problem.numSubdomains)
      .set("Clusters", static_cast<int>(problem.clusters.size()))
      .set("Floating Bodies", floating)
      .set("Kernel Dimension", problem.kernelDimension)
      .set("Ranks", comm.getSize());
  list.sublist("Algorithm")
      .set("Name", fetidp::toString(dual_->algorithm()))
      .set("Reason", dual_->reason())
      .set("Preconditioner", describePreconditioner())
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
  if (std::isfinite(solution.algebraicError))
    list.sublist("Accuracy").set("Algebraic Error", solution.algebraicError);
  list.sublist("Time").set("Setup", times_.setup).set("Solve", times_.solve).set("Recovery", times_.recovery);
  list.sublist("Memory")
      .set("Peak Bytes", sumOverRanks(comm, peakBytes()))
      .set("Factor Bytes", sumOverRanks(comm, static_cast<double>(inverse_->factorBytes() +
                                                                  dual_->preconditionerBytes() + deflated)));
  list.sublist("Status")
      .set("Converged", report_.status == qp::Status::converged)
      .set("Status", qp::toString(report_.status))
      .set("Reason", report_.reason);
  return list;
}

} // namespace epafi
