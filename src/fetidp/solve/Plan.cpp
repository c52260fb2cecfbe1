#include "epafi/fetidp/solve/Plan.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <algorithm>

namespace epafi::fetidp {
namespace {

bool hasPreconditioner(const DualParameters& parameters) {
  return parameters.preconditioner.type != PreconditionerParameters::Type::none;
}

/// Why no less than SMALBE, MPRGP, CG or a direct solve will do.
std::string reasonOf(const PlanFacts& facts) {
  const std::string linear = "no contact: the multipliers only glue subdomains";
  if (facts.numInequalities == 0 && facts.numEqualities == 0)
    return "one piece without contact: one factorisation solves it, nothing to iterate";
  if (facts.numInequalities == 0)
    return linear + (facts.numTies == 0 ? ", a linear problem" : " and tie bodies, a linear problem");
  const std::string contact = facts.numFriction > 0 ? "contact with friction" : "contact";
  if (facts.kernelDimension == 0)
    return contact + ", and every body is held by supports: bound constraints only";
  std::string names;
  for (const std::string& name : facts.floatingBodies)
    names += (names.empty() ? "" : ", ") + name;
  return contact + (facts.numFriction > 0 ? ", and floating " : " with floating ") +
         (names.empty() ? "clusters of subdomains" : "bodies (" + names + ")") +
         ": bounds and equilibrium constraints";
}

/// Active sets where bodies float or the start is good, the contact zone of a coarser mesh.
void chooseAlgorithm(const PlanFacts& facts, const DualParameters& parameters, Plan& plan) {
  using Method = DualParameters::Method;
  plan.reasons["Algorithm"] = reasonOf(facts);
  if (facts.numInequalities == 0) {
    plan.algorithm = facts.numEqualities == 0 ? Algorithm::direct : Algorithm::conjugateGradient;
    return;
  }
  const bool floats = facts.kernelDimension > 0,
             mayBegin = facts.isElastic && facts.primalDimension >= facts.run.coarserFrom,
             isGood = mayBegin && facts.run.hasStart, isOpen = parameters.method == Method::automatic,
             slips = facts.numFriction > 0,
             suits = isOpen ? slips || hasPreconditioner(parameters) : parameters.method != Method::mprgp;
  plan.algorithm = slips && parameters.method == Method::fixedPoint  ? Algorithm::fixedPoint
                   : suits && (!isOpen || floats || isGood || slips) ? Algorithm::activeSets
                   : floats                                          ? Algorithm::smalbe
                                                                     : Algorithm::mprgp;
  plan.reasons["Active Sets"] = !isOpen  ? "as given"
                                : slips  ? "yes: with friction steps of MPRGP end at bounds again and again"
                                : !suits ? "no: there is no preconditioner"
                                : floats ? "yes: where bodies float they save outer iterations"
                                : isGood ? "yes: from a good start they need the fewest products"
                                         : "no: without a good start MPRGP needs fewer products";
  plan.beginsOnCoarserMesh = mayBegin && !isGood && suits;
  plan.reasons["Coarser Start"] =
      !suits      ? "no: it is of use to active sets alone"
      : isGood    ? "there is a start already, from a coarser mesh or an earlier run"
      : !mayBegin ? "no: the problem is solved in less time than it takes, or has no such mesh"
                  : "looked for: the contact zone of a coarser mesh leaves active sets little to find";
}

void chooseTolerance(const PlanFacts& facts, const DualParameters& parameters, Plan& plan) {
  std::string& reason = plan.reasons["Tolerance"];
  if (facts.run.purpose == Purpose::start) {
    plan.tolerance = 1e-4;
    reason = "1e-4: meshes differ by more, and another one starts from here";
  } else if (parameters.isBalanced || parameters.tolerance) {
    plan.isBalanced = parameters.isBalanced;
    plan.tolerance = parameters.tolerance.value_or(plan.tolerance);
    reason = "as given";
  } else if (facts.run.purpose == Purpose::quantity) {
    plan.tolerance = 1e-8;
    reason = "1e-8: numbers are asked to more digits than norms, and what the iteration may be off by is in "
             "their bars";
  } else if (facts.run.purpose == Purpose::mesh) {
    plan.isBalanced = true;
    plan.algebraicFraction = 0.02;
    reason = "balanced, with a fifth of a single run's fraction: some products more, where a target that is "
             "missed by the iteration's share costs another mesh";
  } else {
    reason = "1e-6: the default";
  }
  plan.algebraicFraction = parameters.algebraicFraction.value_or(plan.algebraicFraction);
  if (plan.isBalanced && !hasPreconditioner(parameters))
    throw InputError(
        "parameter \"Tolerance\" in list \"Solver\" is \"balanced\", which measures the algebraic error by "
        "the preconditioner, but the parameter \"Type\" in list \"Solver/Preconditioner\" is \"none\"; "
        "choose \"dirichlet\" or \"lumped\", or a tolerance that is a number.");
}

/// What MPRGP's parameters leave open, with a preconditioner; without, `qp` decides.
void chooseSteps(const PlanFacts& facts, const DualParameters& parameters, Plan& plan) {
  plan.mprgp = parameters.mprgp;
  plan.reasons["Sufficient Share"] = plan.reasons["Proportioning Constant"] = "as given, or 1";
  if (!hasPreconditioner(parameters))
    return;
  if (plan.mprgp.sufficientShare == 0) {
    plan.mprgp.sufficientShare = 0.25;
    plan.reasons["Sufficient Share"] = "0.25: most expansions would fix one multiplier or two";
  }
  // A large penalty makes gradients across Ker G large, and beside these all of a face looks proportional.
  const bool solvesFacesInFewSteps =
      facts.kernelDimension > 0 ? parameters.smalbe.penalty <= 1 : facts.hasAverages && !facts.isCorrected;
  if (plan.mprgp.proportioningConstant == 0 && solvesFacesInFewSteps) {
    plan.mprgp.proportioningConstant = 0.1;
    plan.reasons["Proportioning Constant"] = "0.1: faces take few steps, and those in a wrong one are lost";
  }
}

/// How active sets begin, and how far they solve on a face.
void chooseFaces(const PlanFacts& facts, const DualParameters& parameters, Plan& plan) {
  plan.beginsClosed =
      plan.algorithm == Algorithm::activeSets && (!hasPreconditioner(parameters) || facts.hasDependentRows);
  plan.reasons["First Face"] = plan.beginsClosed ? "all contact closed: M points to no face"
                                                 : "the start's, or that to which M points";
  const bool isCoupled = facts.kernelDimension > 0 && facts.hasClusters && facts.isElastic;
  if (isCoupled) // membranes' contact hardly feels it
    plan.faceReduction = 0.02;
  plan.reasons["Face Reduction"] =
      isCoupled ? "0.02: a new face disturbs the forces between clusters, and these the contact"
                : "0.1: with less, wrong decisions cost faces; with more, right ones cost steps";
}

/// Scaling takes care of jumps of gluing between subdomains. What uneven meshes do to the diagonal costs up
/// to three quarters more products, and constraints more time than they save, but where friction or load
/// steps take many: they have to be cheap in memory.
/// Where a stiff subdomain touches a stiff one, and soft ones hold them, both would rather move: M, which
/// stretches the contact alone, knows nothing of it. Membranes do without: they gain with checkerboards and
/// lose with stripes. A correction at a contact costs products with F and M as it is made, and active sets on
/// their way to the zone gain less by it: ten times the ratio has to pay there.
void chooseSearches(const PlanFacts& facts, const DualParameters& parameters, Plan& plan) {
  using Use = AdaptiveConstraintParameters::Use;
  const AdaptiveConstraintParameters& given = parameters.adaptiveConstraints;
  constexpr double inf = std::numeric_limits<double>::infinity(), factor = 10;
  const bool isOpen = given.use == Use::automatic, isBlind = !hasPreconditioner(parameters);
  plan.gluing = {given, false, 1e9, factor * given.stiffnessRatio};
  plan.contact = {given, facts.isElastic, inf, 0};
  plan.contact.stiffnessRatio *= factor;
  const bool takesMany =
      (facts.numFriction > 0 && facts.run.purpose == Purpose::solution) || facts.run.solvesAgain;
  const bool isNotWorthIt = facts.run.isUniform && !takesMany;
  if (isOpen && (isBlind || isNotWorthIt))
    plan.gluing.use = plan.contact.use = Use::no;
  if (isBlind)
    plan.contact.use = Use::no;
  plan.reasons["Adaptive Constraints"] =
      !isOpen        ? "as given"
      : isBlind      ? "no: there is no preconditioner"
      : isNotWorthIt ? "no: the stiffness varies as sizes of elements do, which costs less than constraints"
                     : "along interfaces with jumps of the stiffness, which the preconditioner overrates";
}

} // namespace

std::string toString(Algorithm algorithm) {
  constexpr const char* names[] = {"Direct", "CG", "MPRGP", "SMALBE-M", "Active sets", "Fixed point"};
  return names[static_cast<int>(algorithm)];
}

PlanFacts factsOf(const decomposition::DecomposedProblem& problem, const RunFacts& run) {
  PlanFacts facts;
  facts.numInequalities = problem.numInequalities;
  facts.numTies = problem.numTies;
  facts.numEqualities = problem.numEqualities;
  facts.numFriction = problem.numFriction;
  facts.primalDimension = problem.primalDimension;
  facts.kernelDimension = problem.kernelDimension;
  for (const auto& body : problem.bodies)
    if (body.kernelDimension > 0)
      facts.floatingBodies.push_back(body.name);
  facts.isElastic = decomposition::isElastic(problem.components);
  facts.hasClusters = problem.clusters.size() > problem.bodies.size();
  facts.hasAverages =
      holdsAnywhere(*problem.comm, std::any_of(problem.subdomains.begin(), problem.subdomains.end(),
                                               [](const auto& own) { return !own.averages.empty(); }));
  facts.run = run;
  return facts;
}

Plan plan(const PlanFacts& facts, const DualParameters& parameters) {
  Plan plan;
  chooseAlgorithm(facts, parameters, plan);
  chooseTolerance(facts, parameters, plan);
  chooseSteps(facts, parameters, plan);
  chooseFaces(facts, parameters, plan);
  chooseSearches(facts, parameters, plan);
  plan.estimatesNorm = plan.algorithm != Algorithm::direct &&
                       (plan.algorithm != Algorithm::conjugateGradient || plan.isBalanced);
  return plan;
}

} // namespace epafi::fetidp
