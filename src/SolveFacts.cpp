// What ContactSolver tells of a solve.

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/PeakMemory.hpp"

#include <Teuchos_Comm.hpp>

#include <sstream>

namespace epafi {

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

SolveFacts ContactSolver::facts() const {
  const auto& problem = *problem_;
  const Comm& comm = *problem.comm;
  SolveFacts facts;
  static_cast<fetidp::PlanFacts&>(facts) = dual_->facts();
  facts.dualDimension = problem.dualDimension();
  facts.numCrosspoints = problem.numCrosspoints;
  facts.numAdaptiveConstraints = numAdaptiveConstraints();
  facts.numSubdomains = problem.numSubdomains;
  facts.numClusters = static_cast<int>(problem.clusters.size());
  facts.numRanks = comm.getSize();
  facts.plan = dual_->plan();
  facts.preconditioner = describePreconditioner();
  facts.dualOperator = describeDualOperator();
  facts.subdomainSolver = dualParameters_.directSolvers.subdomains;
  facts.coarseSolver = dualParameters_.directSolvers.coarse;
  facts.operatorNorm = dual_->norm().norm;
  facts.normMultiplications = dual_->norm().multiplications;
  facts.counts = report_.counts;
  facts.times = times_;
  const std::size_t deflated =
      dual_->deflatedOperator().is_null() ? 0 : dual_->deflatedOperator()->space().bytes();
  facts.peakBytes = sumOverRanks(comm, peakBytes());
  facts.factorBytes = sumOverRanks(
      comm, static_cast<double>(inverse_->factorBytes() + dual_->preconditionerBytes() + deflated));
  facts.status = report_.status;
  facts.statusReason = report_.reason;
  return facts;
}

} // namespace epafi
