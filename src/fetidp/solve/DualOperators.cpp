#include "epafi/fetidp/solve/DualOperators.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/equilibrium/Contradictions.hpp"
#include "epafi/fetidp/equilibrium/ProjectedOperator.hpp"
#include "epafi/fetidp/equilibrium/Solvability.hpp"
#include "epafi/fetidp/precondition/OverratedColumns.hpp"
#include "epafi/fetidp/precondition/SharedRows.hpp"

#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// G. What supports and ties hold is out of balance and contradicts itself at once, most often: the cause is
/// told. Collective.
RCP<const NaturalCoarseSpace> coarseSpace(const DecomposedProblem& problem,
                                          const decomposition::ProblemData& data,
                                          const std::vector<KernelEntry>& entries) try {
  requireContactForEveryMotion(problem, data, entries);
  return rcp(new NaturalCoarseSpace(problem, entries));
} catch (const Error&) { // on all ranks
  if (!data.isEmpty())
    requireFeasibleGaps(problem, data);
  throw;
}

/// M, or PMP + ρ⁻¹Q for the penalty ρ that SMALBE starts with.
void addPreconditioner(const DecomposedProblem& problem, const std::shared_ptr<GeneralizedInverse>& inverse,
                       const Plan& plan, const DualParameters& parameters, DualOperators& operators) {
  operators.dualPreconditioner =
      rcp(new DualPreconditioner(problem, inverse, parameters.preconditioner, operators.deflated));
  operators.preconditioner = operators.dualPreconditioner;
  const double norm = operators.norm.norm > 0 ? operators.norm.norm : 1.0;
  std::vector<LocalOrdinal> shared = ownEntries(problem, *inverse->multiplierPlan()).dependent;
  operators.hasDependentRows = holdsAnywhere(*problem.comm, !shared.empty());
  if (operators.hasDependentRows)
    operators.preconditioner =
        rcp(new ShiftedPreconditioner(operators.preconditioner, std::move(shared), 1 / norm));
  if (const auto jumps = findOverratedColumns(problem, *inverse, RowKind::contact, plan.contact,
                                              parameters.preconditioner.scaling);
      jumps.number > 0)
    operators.preconditioner = operators.corrected = rcp(new CorrectedPreconditioner(
        operators.preconditioner, spaceOf(jumps, *inverse->multiplierPlan(), *operators.flexibility(),
                                          operators.preconditioner.get())));
  operators.facePreconditioner = operators.preconditioner;
  if (!operators.coarseSpace.is_null())
    operators.preconditioner = rcp(new ProjectedOperator(operators.preconditioner, operators.coarseSpace,
                                                         1.0 / (parameters.smalbe.penalty * norm)));
}

} // namespace

RCP<const Operator> DualOperators::flexibility() const {
  if (deflated.is_null())
    return f;
  return deflated;
}

std::size_t DualOperators::preconditionerBytes() const {
  return (dualPreconditioner.is_null() ? 0 : dualPreconditioner->bytes()) +
         (corrected.is_null() ? 0 : corrected->space().bytes());
}

DualOperators makeDualOperators(const DecomposedProblem& problem, const decomposition::ProblemData& data,
                                const Plan& plan, const std::shared_ptr<GeneralizedInverse>& inverse,
                                const std::vector<KernelEntry>& kernelEntries,
                                const DualParameters& parameters) {
  DualOperators operators;
  if (plan.algorithm == Algorithm::direct)
    return operators;
  collectively(*problem.comm, [&] { inverse->prepareDual(parameters.dualOperator); });
  operators.f = rcp(new DualOperator(inverse, problem.compliance));
  if (const auto jumps = findOverratedColumns(problem, *inverse, RowKind::gluing, plan.gluing,
                                              parameters.preconditioner.scaling);
      jumps.number > 0)
    operators.deflated =
        rcp(new qp::DeflatedOperator(operators.f, spaceOf(jumps, *inverse->multiplierPlan(), *operators.f)));
  operators.hessian = operators.flexibility();
  if (problem.kernelDimension > 0) {
    operators.coarseSpace = coarseSpace(problem, data, kernelEntries);
    operators.hessian = rcp(new ProjectedOperator(operators.flexibility(), operators.coarseSpace));
  }
  if (plan.estimatesNorm)
    operators.norm = qp::estimateNorm(*operators.hessian, parameters.norm);
  if (parameters.preconditioner.type != PreconditionerParameters::Type::none)
    addPreconditioner(problem, inverse, plan, parameters, operators);
  return operators;
}

} // namespace epafi::fetidp
