// One solve of the dual problem: what is checked before it, and which way it goes.

#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/equilibrium/Contradictions.hpp"
#include "epafi/fetidp/equilibrium/Friction.hpp"
#include "epafi/fetidp/equilibrium/ProblemChecks.hpp"
#include "epafi/fetidp/equilibrium/Solvability.hpp"
#include "epafi/fetidp/solve/IterativeSolve.hpp"

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// Where there is nothing to iterate.
DualSolution solvedDirectly(const DecomposedProblem& problem) {
  DualSolution solution;
  solution.lambda = rcp(new Vector(problem.multiplierMap));
  solution.report.status = qp::Status::converged;
  solution.report.reason = "solved directly";
  return solution;
}

} // namespace

DualSolution DualProblem::solve(const decomposition::ProblemData& data, const Vector* start,
                                qp::Observer* observer, const ErrorBalance* balance) const {
  if (plan_.isBalanced && balance == nullptr)
    throw InputError("the tolerance 'balanced' needs an estimate of the discretisation error, and none was "
                     "given; hand one over to solve(), or ask for a number");
  requireOwnData(problem_, data);
  requireFiniteData(problem_, data);
  const Eigen::VectorXd resultants = kernelLoad(problem_, data);
  requireFeasibleGaps(problem_, data);
  requireUniqueSolution(problem_, data, kernelEntries_);
  if (problem_.numFriction > 0 && !coarseSpace().is_null())
    requireEnoughFriction(problem_, data, coarseSpace(), resultants);
  if (algorithm() == Algorithm::direct)
    return solvedDirectly(problem_);
  IterativeSolve solve(*this, data, start, observer, plan_.isBalanced ? balance : nullptr);
  DualSolution solution = solve.run(resultants);
  if (solution.report.status == qp::Status::unbounded && !solution.report.certificate.is_null())
    refuseContradiction(problem_, data, *solution.report.certificate);
  return solution;
}

} // namespace epafi::fetidp
