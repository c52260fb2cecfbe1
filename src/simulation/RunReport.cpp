// A result as the list that a report shows.

#include "epafi/base/Version.hpp"
#include "epafi/simulation/RunResult.hpp"

#include <Teuchos_Array.hpp>

#include <cmath>

namespace epafi::simulation {
namespace {

using Teuchos::ParameterList;

Teuchos::Array<double> arrayOf(const std::array<double, 3>& values) {
  return Teuchos::Array<double>(values.begin(), values.end());
}

void enterSolve(const SolveFacts& solve, ParameterList& list) {
  list.sublist("Epafi").set("Version", std::string(version()));
  list.sublist("Problem")
      .set("Primal Dimension", solve.primalDimension)
      .set("Dual Dimension", solve.dualDimension)
      .set("Equality Multipliers", solve.numEqualities)
      .set("Inequality Multipliers", solve.numInequalities)
      .set("Crosspoints", solve.numCrosspoints)
      .set("Adaptive Constraints", solve.numAdaptiveConstraints)
      .set("Subdomains", solve.numSubdomains)
      .set("Clusters", solve.numClusters)
      .set("Floating Bodies", static_cast<int>(solve.floatingBodies.size()))
      .set("Kernel Dimension", solve.kernelDimension)
      .set("Ranks", solve.numRanks);
  list.sublist("Algorithm")
      .set("Name", fetidp::toString(solve.plan.algorithm))
      .set("Reason", solve.plan.reasons.at("Algorithm"))
      .set("Preconditioner", solve.preconditioner)
      .set("Dual Operator", solve.dualOperator)
      .set("Subdomain Solver", solve.subdomainSolver)
      .set("Coarse Solver", solve.coarseSolver)
      .set("Operator Norm", solve.operatorNorm);
  for (const auto& [choice, reason] : solve.plan.reasons)
    list.sublist("Plan").set(choice, reason);
  list.sublist("Iterations")
      .set("Outer", solve.counts.outer)
      .set("CG Steps", solve.counts.conjugateGradient)
      .set("Expansion Steps", solve.counts.expansion)
      .set("Proportioning Steps", solve.counts.proportioning)
      .set("Hessian Multiplications", solve.counts.hessianMultiplications)
      .set("Norm Estimate Multiplications", solve.normMultiplications)
      .set("Preconditioner Applications", solve.counts.preconditionerApplications);
  if (solve.counts.negativeCurvatures > 0)
    list.sublist("Iterations").set("Negative Curvatures", solve.counts.negativeCurvatures);
  if (solve.counts.fixedPointRounds > 0)
    list.sublist("Iterations").set("Fixed Point Rounds", solve.counts.fixedPointRounds);
}

void enterFeedback(const std::optional<FrictionFeedback>& feedback, ParameterList& list) {
  if (feedback)
    list.set("Friction Feedback", feedback->factor)
        .set("Friction Feedback Multiplications", feedback->multiplications);
}

void enterAccuracy(const RunResult& result, ParameterList& list) {
  list.set("Relative Projected Gradient", result.relativeProjectedGradient)
      .set("Feasibility", result.feasibility)
      .set("Complementarity", result.complementarity)
      .set("Equilibrium", result.equilibrium)
      .set("Energy", result.energy)
      .set("Active Contact Nodes", result.activeContactNodes)
      .set("Contact Force", result.contactForce)
      .set("Strain Energy", result.energy + result.loadWork)
      .set("Load Work", result.loadWork);
  enterFeedback(result.feedback, list);
  if (std::isfinite(result.algebraicError))
    list.set("Algebraic Error", result.algebraicError);
  if (result.error)
    list.set("Energy Norm", result.error->energyNorm)
        .set("Discretisation Error", result.error->discretisation)
        .set("Relative Error", result.error->relative());
  if (result.target) {
    list.set("Effectivity", result.error->effectivity).set("Target", result.target->asked);
    if (!result.target->choiceOfOrder.empty())
      list.set("Choice of Order", result.target->choiceOfOrder);
  }
  if (!result.doubts.empty())
    list.set("Doubts", result.doubts);
}

void enterBound(const accuracy::EnergyBound& bound, ParameterList& list) {
  list.set("Imbalance", bound.imbalance);
  if (!bound.failure.empty()) {
    list.set("Reason", bound.failure);
    return;
  }
  list.set("Lower Energy", bound.lower)
      .set("Upper Energy", bound.upper)
      .set("Error", bound.error)
      .set("Relative Error", bound.relative())
      .set("Discretisation", bound.discretisation)
      .set("Contact", bound.contact)
      .set("Oscillation", bound.oscillation)
      .set("Round-off", bound.roundOff)
      .set("Correction", bound.correction)
      .set("Steps", bound.steps);
}

void enterQuantity(const Quantity& quantity, ParameterList& list) {
  list.set("Name", quantity.name).set("Value", quantity.value);
  if (quantity.failure.empty())
    list.set("Error Bar", quantity.bar + quantity.algebraic)
        .set("Estimated Error", quantity.error)
        .set("Hessian Multiplications", quantity.multiplications);
  else
    list.set("Reason", quantity.failure);
}

void enterStart(const CoarserStart& start, ParameterList& list) {
  if (!start.failure.empty())
    list.set("Failure", start.failure);
  if (!start.means.empty())
    list.set("Mesh", start.means)
        .set("Primal Dimension", start.unknowns)
        .set("Hessian Multiplications", start.multiplications);
}

void enterBalance(const JointBalance& balance, ParameterList& list) {
  list.set("Coupling", balance.coupling)
      .set("Force Imbalance", balance.force)
      .set("Moment Imbalance", balance.moment);
}

void enterFriction(const ContactResult& contact, ParameterList& list) {
  list.set("Normal Force", contact.force)
      .set("Tangential Force", arrayOf(contact.friction->tangentialForce))
      .set("Moment", arrayOf(contact.friction->moment))
      .set("Tangential Moment", arrayOf(contact.friction->tangentialMoment))
      .set("Centre", arrayOf(contact.friction->centre))
      .set("Moment about Centre", arrayOf(contact.friction->centreMoment))
      .set("Tangential Moment about Centre", arrayOf(contact.friction->centreTangential))
      .set("Stick Area", contact.friction->stickArea)
      .set("Slip Area", contact.friction->slipArea)
      .set("Open Area", contact.friction->openArea)
      .set("Dissipation", contact.friction->dissipation)
      .set("Largest Slip", contact.friction->largestSlip);
}

void enterContact(const ContactResult& contact, ParameterList& list) {
  list.set("Candidates", contact.candidates)
      .set("Active Nodes", contact.activeNodes)
      .set("Force", contact.force)
      .set("Resultant", arrayOf(contact.resultant))
      .set("Largest Pressure", contact.largestPressure)
      .set("Contact Area", contact.area);
  if (!contact.note.empty())
    list.set("Note", contact.note);
  if (contact.numBent > 0)
    list.set("Bent Nodes", contact.numBent);
  if (contact.penetration)
    list.set("Largest Penetration", *contact.penetration);
  if (contact.balance)
    enterBalance(*contact.balance, list);
  if (contact.friction)
    enterFriction(contact, list);
}

void enterTie(const TieResult& tie, ParameterList& list) {
  list.set("Nodes", tie.nodes)
      .set("Resultant", arrayOf(tie.resultant))
      .set("Largest Traction", tie.largestTraction);
  if (!tie.note.empty())
    list.set("Note", tie.note);
  enterBalance(tie.balance, list);
}

void enterSupports(const std::vector<SupportResult>& supports, ParameterList& list) {
  for (const SupportResult& support : supports)
    list.sublist("Support")
        .sublist(support.body)
        .sublist(support.name)
        .set("Force", arrayOf(support.force))
        .set("Moment", arrayOf(support.moment));
}

void enterPreload(const PreloadResult& preload, ParameterList& list) {
  list.set("Force", preload.force).set("Shortening", preload.shortening);
}

void enterHolds(const std::vector<HoldResult>& holds, ParameterList& list) {
  for (const HoldResult& hold : holds)
    list.sublist("Holds")
        .sublist(hold.motion)
        .set("Force", arrayOf(hold.force))
        .set("Place", arrayOf(hold.place));
}

void enterStep(const StepResult& step, ParameterList& list) {
  list.set("Hessian Multiplications", step.multiplications)
      .set("Strain Energy", step.strainEnergy)
      .set("Load Work", step.loadWork)
      .set("Dissipation", step.dissipation)
      .set("Converged", step.status == RunStatus::converged)
      .set("Reason", step.reason);
  enterFeedback(step.feedback, list);
  for (const ContactResult& contact : step.contacts)
    enterContact(contact, list.sublist("Contact").sublist(contact.name));
  enterSupports(step.supports, list);
  for (const PreloadResult& preload : step.preloads)
    enterPreload(preload, list.sublist("Preload").sublist(preload.name));
  for (const TieResult& tie : step.ties)
    enterTie(tie, list.sublist("Tied").sublist(tie.name));
  enterHolds(step.holds, list);
  if (!step.doubts.empty())
    list.set("Doubts", step.doubts);
}

void enterMesh(const accuracy::MeshResult& mesh, ParameterList& list) {
  if (mesh.quantity)
    list.set("Quantity", mesh.quantity->value)
        .set("Error Bar", mesh.quantity->discretisation + mesh.quantity->algebraic);
  list.set("Order", mesh.order)
      .set("Primal Dimension", mesh.unknowns)
      .set("Hessian Multiplications", mesh.multiplications)
      .set("Relative Error", mesh.relative())
      .set("Discretisation Error", mesh.discretisation)
      .set("Algebraic Error", mesh.algebraic)
      .set("Effectivity", mesh.effectivity)
      .set("Seconds", mesh.seconds);
}

void enterCosts(const RunResult& result, ParameterList& list) {
  ParameterList& times = list.sublist("Time");
  times.set("Assembly", result.times.assembly)
      .set("Setup", result.solve.times.setup)
      .set("Solve", result.solve.times.solve)
      .set("Recovery", result.times.recovery);
  if (result.start)
    times.set("Start", result.start->seconds);
  if (result.error)
    times.set("Error Estimate", result.times.errorEstimate);
  if (result.bound)
    times.set("Bound", result.times.bound);
  if (result.times.output > 0)
    times.set("Output", result.times.output);
  if (result.times.total > 0)
    times.set("Total", result.times.total);
  list.sublist("Memory")
      .set("Peak Bytes", result.solve.peakBytes)
      .set("Factor Bytes", result.solve.factorBytes);
}

} // namespace

double ErrorResult::relative() const {
  if (std::isinf(algebraic)) // nothing bounds it
    return algebraic;
  const double absolute = std::hypot(discretisation, std::isnan(algebraic) ? 0 : algebraic);
  const double whole = std::hypot(energyNorm, absolute);
  return whole > 0 ? absolute / whole : 0;
}

std::string largeDeformations(const RunResult& result, double limit) {
  std::string large;
  for (const BodyResult& body : result.bodies)
    if (body.deformation.isAbove(limit))
      large += (large.empty() ? "" : "; ") + body.name + ": " + inWords(body.deformation);
  return large.empty() ? large
                       : "displacements are taken to be small, and are not (" + large +
                             "): a program for large ones is needed, or smaller loads";
}

void requireSmall(RunResult& result) {
  const std::string large = largeDeformations(result, Deformation::large);
  if (large.empty() || result.status != RunStatus::converged)
    return;
  result.status = RunStatus::largeDisplacements;
  result.reason = large;
}

void requireAllContacts(RunResult& result) {
  if (result.missedContacts.empty() ||
      (result.status != RunStatus::converged && result.status != RunStatus::targetMissed))
    return;
  result.status = RunStatus::missedContact;
  result.reason = result.missedContacts;
}

std::string statusOf(const RunResult& result) {
  switch (result.status) {
  case RunStatus::converged:
    return "Converged";
  case RunStatus::targetMissed:
    return "TargetMissed";
  case RunStatus::largeDisplacements:
    return "LargeDisplacements";
  case RunStatus::missedContact:
    return "MissedContact";
  case RunStatus::interrupted:
    return "Interrupted";
  case RunStatus::running:
    return "Running";
  case RunStatus::notConverged:
    break;
  }
  return qp::toString(result.solve.status);
}

ParameterList reportOf(const RunResult& result) {
  ParameterList list("Report");
  enterSolve(result.solve, list);
  list.sublist("Problem").set("Title", result.title);
  if (!result.notes.empty())
    list.sublist("Problem").set("Notes", Teuchos::Array<std::string>(result.notes));
  enterAccuracy(result, list.sublist("Accuracy"));
  if (result.start)
    enterStart(*result.start, list.sublist("Start"));
  if (result.bound)
    enterBound(*result.bound, list.sublist("Bound"));
  if (result.quantity)
    enterQuantity(*result.quantity, list.sublist("Quantity"));
  for (const ContactResult& contact : result.contacts)
    enterContact(contact, list.sublist("Contact").sublist(contact.name));
  for (const TieResult& tie : result.ties)
    enterTie(tie, list.sublist("Tied").sublist(tie.name));
  enterSupports(result.supports, list);
  for (const PreloadResult& preload : result.preloads)
    enterPreload(preload, list.sublist("Preload").sublist(preload.name));
  enterHolds(result.holds, list);
  for (const BodyResult& body : result.bodies)
    if (body.isElastic)
      list.sublist("Body")
          .sublist(body.name)
          .set("Largest Displacement", body.largestDisplacement)
          .set("Largest von Mises Stress", body.largestStress)
          .set("Largest Strain", body.deformation.strain)
          .set("Largest Rotation", body.deformation.rotation);
  for (const StepResult& step : result.steps)
    enterStep(step, list.sublist("Steps").sublist(step.name));
  if (result.target)
    for (std::size_t i = 0; i < result.target->meshes.size(); ++i)
      enterMesh(result.target->meshes[i], list.sublist("Levels").sublist("level " + std::to_string(i)));
  enterCosts(result, list);
  list.sublist("Status")
      .set("Converged", result.status == RunStatus::converged)
      .set("Status", statusOf(result))
      .set("Reason", result.reason);
  return list;
}

} // namespace epafi::simulation
