#include "epafi/fetidp/DualOperators.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/Contradictions.hpp"
#include "epafi/fetidp/OverratedColumns.hpp"
#include "epafi/fetidp/ProjectedOperator.hpp"
#include "epafi/fetidp/ProjectedPreconditioner.hpp"
#include "epafi/fetidp/SharedRows.hpp"
#include "epafi/fetidp/Solvability.hpp"

#include <algorithm>
#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// F_U, or null if there are no adaptive constraints.
RCP<const qp::DeflatedOperator> deflatedOperator(const DecomposedProblem& problem,
                                                 GeneralizedInverse& inverse,
                                                 const RCP<const DualOperator>& f,
                                                 const DualParameters& parameters) {
  using Use = AdaptiveConstraintParameters::Use;
  const Use use = parameters.adaptiveConstraints.use;
  const bool hasPreconditioner = parameters.preconditioner.type != PreconditionerParameters::Type::none;
  if (use == Use::no || (use == Use::automatic && !hasPreconditioner))
    return Teuchos::null;
  const OverratedColumns columns = findOverratedColumns(
      problem, inverse, RowKind::gluing, parameters.adaptiveConstraints, parameters.preconditioner.scaling);
  if (columns.number == 0)
    return Teuchos::null;
  return rcp(new qp::DeflatedOperator(f, spaceOf(columns, *inverse.multiplierPlan(), *f)));
}

/// M corrected for the jumps of contact that it overrates, or null if there are none.
RCP<const CorrectedPreconditioner> correctedPreconditioner(const DecomposedProblem& problem,
                                                           GeneralizedInverse& inverse,
                                                           const DualOperators& operators,
                                                           const DualParameters& parameters) {
  if (parameters.adaptiveConstraints.use == AdaptiveConstraintParameters::Use::no)
    return Teuchos::null;
  const OverratedColumns columns = findOverratedColumns(
      problem, inverse, RowKind::contact, parameters.adaptiveConstraints, parameters.preconditioner.scaling);
  if (columns.number == 0)
    return Teuchos::null;
  return rcp(new CorrectedPreconditioner(
      operators.preconditioner,
      spaceOf(columns, *inverse.multiplierPlan(), *operators.flexibility(), operators.preconditioner.get())));
}

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
                       const DualParameters& parameters, DualOperators& operators) {
  operators.dualPreconditioner =
      rcp(new DualPreconditioner(problem, inverse, parameters.preconditioner, operators.deflated));
  operators.preconditioner = operators.dualPreconditioner;
  const double norm = operators.norm.norm > 0 ? operators.norm.norm : 1.0;
  std::vector<LocalOrdinal> shared = ownEntries(problem, *inverse->multiplierPlan()).dependent;
  operators.hasDependentRows = holdsAnywhere(*problem.comm, !shared.empty());
  if (operators.hasDependentRows)
    operators.preconditioner =
        rcp(new ShiftedPreconditioner(operators.preconditioner, std::move(shared), 1 / norm));
  operators.corrected = correctedPreconditioner(problem, *inverse, operators, parameters);
  if (!operators.corrected.is_null())
    operators.preconditioner = operators.corrected;
  operators.facePreconditioner = operators.preconditioner;
  if (!operators.coarseSpace.is_null())
    operators.preconditioner = rcp(new ProjectedPreconditioner(
        operators.preconditioner, operators.coarseSpace, parameters.smalbe.penalty * norm));
}

/// Whether averages along edges are coarse unknowns, somewhere. Collective.
bool hasAverages(const DecomposedProblem& problem) {
  return holdsAnywhere(*problem.comm,
                       std::any_of(problem.subdomains.begin(), problem.subdomains.end(),
                                   [](const auto& subdomain) { return !subdomain.averages.empty(); }));
}

/// With a preconditioner, what the parameters leave open. Collective.
qp::MprgpParameters preconditionedMprgp(const DecomposedProblem& problem, bool isCorrected,
                                        const DualParameters& parameters) {
  qp::MprgpParameters mprgp = parameters.mprgp;
  if (mprgp.sufficientShare == 0)
    mprgp.sufficientShare = 0.25; // most expansions would fix one multiplier or two
  // A large penalty makes gradients across Ker G large, and beside these all of a face looks proportional.
  const bool solvesFacesInFewSteps =
      problem.kernelDimension > 0 ? parameters.smalbe.penalty <= 1 : hasAverages(problem) && !isCorrected;
  if (mprgp.proportioningConstant == 0 && solvesFacesInFewSteps)
    mprgp.proportioningConstant = 0.1; // steps in a wrong face are lost
  return mprgp;
}

} // namespace

std::string toString(Algorithm algorithm) {
  constexpr const char* names[] = {"Direct", "CG", "MPRGP", "SMALBE-M", "Active sets"};
  return names[static_cast<int>(algorithm)];
}

AlgorithmChoice leastAlgorithm(const DecomposedProblem& problem) {
  if (problem.dualDimension() == 0)
    return {Algorithm::direct, "one piece without contact: one factorisation solves it, nothing to iterate"};
  if (problem.numInequalities == 0)
    return {Algorithm::conjugateGradient,
            problem.numTies == 0
                ? "no contact: the multipliers only glue subdomains, a linear problem"
                : "no contact: the multipliers only glue subdomains and tie bodies, a linear problem"};
  if (problem.kernelDimension == 0)
    return {Algorithm::mprgp, "contact, and every body is held by supports: bound constraints only"};
  std::string names;
  for (const auto& body : problem.bodies)
    if (body.kernelDimension > 0)
      names += (names.empty() ? "" : ", ") + body.name;
  if (names.empty())
    return {Algorithm::smalbe,
            "contact with floating clusters of subdomains: bounds and equilibrium constraints"};
  return {Algorithm::smalbe,
          "contact with floating bodies (" + names + "): bounds and equilibrium constraints"};
}

AlgorithmChoice chosenAlgorithm(const DecomposedProblem& problem, const DualParameters& parameters) {
  using Method = DualParameters::Method;
  AlgorithmChoice choice = leastAlgorithm(problem);
  const bool hasContact = choice.algorithm == Algorithm::mprgp || choice.algorithm == Algorithm::smalbe;
  const bool saves = choice.algorithm == Algorithm::smalbe &&
                     parameters.preconditioner.type != PreconditionerParameters::Type::none;
  if (hasContact &&
      (parameters.method == Method::activeSets || (parameters.method == Method::automatic && saves)))
    choice.algorithm = Algorithm::activeSets;
  return choice;
}

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
                                Algorithm algorithm, const std::shared_ptr<GeneralizedInverse>& inverse,
                                const std::vector<KernelEntry>& kernelEntries,
                                const DualParameters& parameters) {
  DualOperators operators;
  operators.mprgp = parameters.mprgp;
  if (algorithm == Algorithm::direct)
    return operators;
  collectively(*problem.comm, [&] { inverse->prepareDual(parameters.dualOperator); });
  operators.f = rcp(new DualOperator(inverse));
  operators.deflated = deflatedOperator(problem, *inverse, operators.f, parameters);
  operators.hessian = operators.flexibility();
  if (problem.kernelDimension > 0) {
    operators.coarseSpace = coarseSpace(problem, data, kernelEntries);
    operators.hessian = rcp(new ProjectedOperator(operators.flexibility(), operators.coarseSpace));
  }
  if (algorithm != Algorithm::conjugateGradient || parameters.isBalanced)
    operators.norm = qp::estimateNorm(*operators.hessian, parameters.norm);
  if (parameters.preconditioner.type != PreconditionerParameters::Type::none) {
    addPreconditioner(problem, inverse, parameters, operators);
    operators.mprgp = preconditionedMprgp(problem, !operators.corrected.is_null(), parameters);
  }
  return operators;
}

} // namespace epafi::fetidp
