#include "epafi/fetidp/operator/FetiParameters.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/direct/SpdFactor.hpp"

#include <vector>

namespace epafi::fetidp {
namespace {

// In the order of the enumerators.
const std::vector<std::string> operatorModes = {"auto", "implicit", "explicit"};
const std::vector<std::string> types = {"none", "lumped", "dirichlet"};
const std::vector<std::string> scalings = {"multiplicity", "stiffness"};
const std::vector<std::string> uses = {"auto", "yes", "no"};

std::vector<std::string> solverNames() {
  std::vector<std::string> names = direct::availableSolvers();
  names.insert(names.begin(), "auto");
  return names;
}

std::string resolved(const std::string& solver) {
  return solver == "auto" ? direct::fastestSolver() : solver;
}

void addAdaptiveConstraintParameters(Teuchos::ParameterList& list) {
  const AdaptiveConstraintParameters defaults;
  addChoice(list, "Use", "auto",
            "Whether jumps between subdomains that the preconditioner overrates are looked for along "
            "interfaces, by eigenproblems, and taken out of the iteration: along all ('yes'), or with a "
            "preconditioner along those where the stiffness jumps ('auto'); in a scene without several "
            "materials in a body only where friction or load steps take many products.",
            uses);
  addReal(list, "Threshold", defaults.threshold,
          "Jumps are constrained whose energy the preconditioner overrates by more than this factor. Lower: "
          "more constraints, fewer products.",
          1.0);
  addReal(list, "Stiffness Ratio", defaults.stiffnessRatio,
          "Largest over smallest stiffness, from which on 'auto' looks at an interface: along it within one "
          "subdomain; ten times that where the dense blocks of these subdomains would take more than 1 GB in "
          "all, "
          "and at contacts, there also between subdomains of an elastic body.",
          1.0);
  addInteger(list, "Maximum Number", defaults.maxNumber,
             "Constraints at most, the worst jumps first. Each takes a product with F in the setup, and "
             "memory for one number a multiplier.",
             1);
}

} // namespace

std::string toString(PreconditionerParameters::Type type) {
  return types[static_cast<std::size_t>(type)];
}

std::string describe(const PreconditionerParameters& parameters) {
  if (parameters.type == PreconditionerParameters::Type::none)
    return toString(parameters.type);
  const bool byStiffness = parameters.scaling == PreconditionerParameters::Scaling::stiffness;
  return toString(parameters.type) + (byStiffness ? ", stiffness scaling" : ", multiplicity scaling") +
         (parameters.isSingle ? ", single precision" : "");
}

void addFetiParameters(Teuchos::ParameterList& list) {
  const DualOperatorParameters operatorDefaults;
  const PreconditionerParameters preconditionerDefaults;
  Teuchos::ParameterList& solvers = list.sublist("Direct Solvers");
  addChoice(
      solvers, "Subdomains", "auto",
      "Direct solver of the subdomains; 'auto' is the one that was fastest where it was measured, CHOLMOD.",
      solverNames());
  addChoice(solvers, "Coarse Problem", "auto", "Direct solver of the coarse problem; 'auto' likewise.",
            solverNames());
  addChoice(
      solvers, "Share Identical Subdomains", DirectSolvers().shareIdentical ? "yes" : "no",
      "Whether subdomains with equal matrices, found by comparing them, share one factor and dense block.",
      {"yes", "no"});
  addInteger(solvers, "Maximum Replicated Size", DirectSolvers().maxReplicated,
             "Coarse unknowns up to which every rank holds and solves the coarse problem, which takes one "
             "message and gives the same digits on any number of ranks; beyond, rank 0 alone does.");
  Teuchos::ParameterList& dual = list.sublist("Dual Operator");
  addChoice(dual, "Mode", "auto",
            "How F is multiplied with: 'implicit' by two triangular solves a subdomain, 'explicit' by "
            "a dense block each, 'auto' by what is less work for the expected products. The preconditioner "
            "follows it in subdomains that are like no other.",
            operatorModes);
  addInteger(dual, "Expected Products", operatorDefaults.expectedProducts,
             "Products with F in which explicit blocks must pay off, for 'auto'.", 1);
  Teuchos::ParameterList& preconditioner = list.sublist("Preconditioner");
  addChoice(preconditioner, "Type", toString(preconditionerDefaults.type),
            "Preconditioner of F: each subdomain's stiffness condensed to its interface ('dirichlet'), or "
            "that stiffness alone ('lumped').",
            types);
  addChoice(preconditioner, "Scaling", "stiffness",
            "How an interface's forces are shared by the subdomains that meet there: by the diagonal of "
            "their stiffness, or equally.",
            scalings);
  addChoice(preconditioner, "Precision", preconditionerDefaults.isSingle ? "single" : "double",
            "Of the preconditioner's blocks; the solution is as accurate with either.", {"single", "double"});
  addAdaptiveConstraintParameters(list.sublist("Adaptive Constraints"));
}

FetiParameters fetiParametersFrom(const Teuchos::ParameterList& list) {
  return {directSolversFrom(list.sublist("Direct Solvers")), dualOperatorFrom(list.sublist("Dual Operator")),
          preconditionerFrom(list.sublist("Preconditioner")),
          adaptiveConstraintsFrom(list.sublist("Adaptive Constraints"))};
}

DirectSolvers directSolversFrom(const Teuchos::ParameterList& list) {
  return {resolved(list.get<std::string>("Subdomains")), resolved(list.get<std::string>("Coarse Problem")),
          list.get<std::string>("Share Identical Subdomains") == "yes",
          list.get<int>("Maximum Replicated Size")};
}

DualOperatorParameters dualOperatorFrom(const Teuchos::ParameterList& list) {
  return {enumeratorFrom<DualOperatorParameters::Mode>(list, "Mode", operatorModes),
          list.get<int>("Expected Products")};
}

PreconditionerParameters::Scaling scalingFrom(const Teuchos::ParameterList& list) {
  return enumeratorFrom<PreconditionerParameters::Scaling>(list, "Scaling", scalings);
}

PreconditionerParameters preconditionerFrom(const Teuchos::ParameterList& list) {
  return {enumeratorFrom<PreconditionerParameters::Type>(list, "Type", types), scalingFrom(list),
          list.get<std::string>("Precision") == "single"};
}

AdaptiveConstraintParameters adaptiveConstraintsFrom(const Teuchos::ParameterList& list) {
  return {enumeratorFrom<AdaptiveConstraintParameters::Use>(list, "Use", uses), list.get<double>("Threshold"),
          list.get<double>("Stiffness Ratio"), list.get<int>("Maximum Number")};
}

} // namespace epafi::fetidp
