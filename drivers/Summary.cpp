#include "Summary.hpp"

#include "NumberText.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <vector>

namespace epafi::drivers {
namespace {

using simulation::RunResult;

/// Names of the floating bodies; empty if there are none.
std::string floatingBodies(const RunResult& result) {
  std::string names;
  for (const simulation::BodyResult& body : result.bodies)
    if (body.floats)
      names += (names.empty() ? "" : ", ") + body.name;
  return names;
}

void describeProblem(std::ostream& text, const RunResult& result) {
  const SolveFacts& solve = result.solve;
  text << "  problem     " << counted(solve.primalDimension, "primal unknown") << " in "
       << counted(solve.numSubdomains, "subdomain") << " on " << counted(solve.numRanks, "rank") << ", "
       << counted(solve.numCrosspoints, "crosspoint") << "\n              "
       << counted(solve.dualDimension, "multiplier") << ": " << solve.numInequalities << " of contact, ";
  if (solve.numTies > 0)
    text << solve.numTies << " of tied joints, ";
  text << solve.numEqualities - solve.numTies << " of gluing\n";
  for (const simulation::BodyResult& body : result.bodies)
    if (body.askedParts > 0 && body.askedParts != body.parts)
      text << "              METIS cut body '" << body.name << "' into "
           << counted(body.parts, "connected part") << ", not the " << body.askedParts << " asked for\n";
  if (solve.numClusters > std::ssize(result.bodies))
    text << "  clusters    " << solve.numClusters << " of subdomains that share crosspoints, "
         << counted(solve.kernelDimension, "rigid motion") << " of them"
         << (result.choosesClusters
                 ? ": with so many subdomains and ranks faster than crosspoints of whole bodies\n"
                 : "\n");
  const std::string floating = floatingBodies(result);
  text << "  floating    " << (floating.empty() ? "no body" : floating) << '\n';
}

void describeStart(std::ostream& text, const simulation::CoarserStart& start) {
  text << "  start       ";
  if (start.failure.empty())
    text << "contact zone of " << start.means << ": " << counted(start.unknowns, "primal unknown") << ", "
         << counted(start.multiplications, "product") << " with F\n";
  else
    text << "from nothing, as a coarser mesh failed: " << start.failure << '\n';
}

void describeSolution(std::ostream& text, const RunResult& result) {
  const SolveFacts& solve = result.solve;
  text << "  algorithm   " << fetidp::toString(solve.plan.algorithm) << ": "
       << solve.plan.reasons.at("Algorithm") << "\n              preconditioner " << solve.preconditioner
       << ", subdomains by " << solve.subdomainSolver << ", coarse problem by " << solve.coarseSolver
       << "\n              F " << solve.dualOperator << '\n';
  if (result.start)
    describeStart(text, *result.start);
  text << "  iterations  " << counted(solve.counts.hessianMultiplications, "product") << " with F (and "
       << solve.normMultiplications << " to estimate its norm): " << solve.counts.conjugateGradient
       << " CG + " << solve.counts.expansion << " expansion + " << solve.counts.proportioning
       << " proportioning steps, " << solve.counts.outer << " outer\n";
  if (result.feedback)
    text << "              friction's bounds feed back by a factor of " << rounded(result.feedback->factor)
         << " (" << counted(result.feedback->multiplications, "more product") << ")\n";
}

void describeQuantity(std::ostream& text, const simulation::Quantity& quantity) {
  text << "\n  quantity    " << quantity.name << ": ";
  if (quantity.failure.empty())
    text << valueWithBar(quantity.value, quantity.bar + quantity.algebraic)
         << "; its error is estimated to be " << std::setprecision(2) << quantity.error;
  else
    text << std::setprecision(8) << quantity.value << ", without an error bar: " << quantity.failure;
}

/// What of the error the mesh and what the iteration is to blame for.
void describeError(std::ostream& text, const simulation::ErrorResult& error) {
  const double whole = std::hypot(error.energyNorm, error.discretisation);
  const auto share = [whole](double absolute) { return percent(whole > 0 ? absolute / whole : 0); };
  text << "\n              estimated error ";
  if (!std::isinf(error.algebraic))
    text << percent(error.relative()) << " of the energy norm: ";
  text << share(error.discretisation) << " of the mesh, ";
  if (std::isfinite(error.algebraic))
    text << share(error.algebraic) << " of the iteration";
  else
    text << "that of the iteration not "
         << (std::isnan(error.algebraic) ? "measured" : "bounded by anything");
}

/// Energies below and above the exact one, and what takes how much of the distance.
void describeBound(std::ostream& text, const accuracy::EnergyBound& bound) {
  text << "\n  bound       ";
  if (!bound.failure.empty()) {
    text << "not guaranteed: " << bound.failure;
    return;
  }
  const double width = bound.upper - bound.lower;
  const auto part = [&](double value, const char* name) {
    constexpr double worthSaying = 5e-5;
    if (value > worthSaying * width)
      text << ", " << percent(value / width) << ' ' << name;
  };
  text << "energy between " << scientific(bound.lower, 9) << " and " << scientific(bound.upper, 9) << " ("
       << percent(width / std::abs(bound.upper)) << "), error at most " << percent(bound.relative())
       << " of the energy norm, guaranteed on the meshed bodies"
       << "\n              of the distance " << percent(bound.discretisation / width) << " discretisation";
  part(bound.contact, "contact");
  part(bound.oscillation, "oscillation of loads");
  part(bound.roundOff, "round-off (estimated)");
}

void describeAccuracy(std::ostream& text, const RunResult& result) {
  std::ostringstream asked;
  if (result.solve.plan.isBalanced)
    asked << "balanced";
  else
    asked << result.solve.plan.tolerance;
  text << "  accuracy    projected gradient " << scientific(result.relativeProjectedGradient, 2) << " (asked "
       << asked.str() << "), feasibility " << scientific(result.feasibility, 2) << ", complementarity "
       << scientific(result.complementarity, 2);
  if (!floatingBodies(result).empty())
    text << ", equilibrium " << scientific(result.equilibrium, 2);
  if (result.error)
    describeError(text, *result.error);
  if (result.bound)
    describeBound(text, *result.bound);
  if (!result.doubts.empty())
    text << "\n  doubts      " << result.doubts;
  if (result.quantity)
    describeQuantity(text, *result.quantity);
  if (result.target && !result.target->choiceOfOrder.empty())
    text << "\n  order       " << result.target->choiceOfOrder;
  text << "\n  solution    energy " << scientific(result.energy, 9);
  if (result.solve.numInequalities > 0)
    text << ", contact force " << scientific(result.contactForce, 9) << " on "
         << counted(result.activeContactNodes, "closed node");
  text << '\n';
}

double lengthOf(const std::array<double, 3>& force) {
  return std::hypot(force[0], force[1], force[2]);
}

/// ", resultant 256.76" where it is another thing than the sum of the nodes' forces: these turn with the
/// surface, and their resultant is what a load holds.
std::string resultantOf(const simulation::ContactResult& contact) {
  constexpr double alike = 0.02;
  const double resultant = lengthOf(contact.resultant);
  if (std::abs(contact.force - resultant) <= alike * std::abs(contact.force))
    return "";
  return ", resultant " + rounded(resultant);
}

/// One line an entry, the first ones only if there are many. `line` adds what an entry says.
template <class Entries, class Line>
void describeEach(std::ostream& text, const Entries& entries, const std::string& label, Line line) {
  constexpr std::size_t most = 8;
  for (std::size_t i = 0; i < std::min(most, entries.size()); ++i) {
    text << "  " << std::left << std::setw(12) << label << entries[i].name << ": ";
    line(entries[i]);
    text << '\n';
  }
  if (entries.size() > most)
    text << "              and " << entries.size() - most << " more in the report\n";
}

const char* const noteIndent = "\n                ";

void addBalance(std::ostream& text, const simulation::JointBalance& balance) {
  constexpr double balanced = 1e-3;
  if (balance.moment > balanced)
    text << noteIndent << "the forces on both sides are out of balance by " << percent(balance.moment)
         << " in moment: they do not lie across each other";
}

void describeFriction(std::ostream& text, const simulation::FrictionResult& friction) {
  const auto& [x, y, z] = friction.tangentialForce;
  text << noteIndent << "friction: force (" << rounded(x) << ", " << rounded(y) << ", " << rounded(z)
       << "), sticks on " << rounded(friction.stickArea) << ", slips on " << rounded(friction.slipArea)
       << " by at most " << rounded(friction.largestSlip) << ", dissipation "
       << rounded(friction.dissipation);
}

void describeContact(std::ostream& text, const simulation::ContactResult& contact) {
  text << contact.activeNodes << " of " << counted(contact.candidates, "node") << " closed, area "
       << rounded(contact.area) << ", force " << rounded(contact.force) << resultantOf(contact)
       << ", largest pressure " << rounded(contact.largestPressure);
  if (contact.penetration)
    text << ", penetration " << rounded(*contact.penetration);
  if (contact.balance)
    text << "; " << contact.balance->coupling;
  if (contact.friction)
    describeFriction(text, *contact.friction);
  if (!contact.note.empty())
    text << noteIndent << contact.note;
  if (contact.numBent > 0)
    text << noteIndent << "a surface bends sharply at " << counted(contact.numBent, "contact node")
         << " more than one face of which meets the other side; the normal there is their mean: give the "
            "faces contacts of their own";
  if (contact.balance)
    addBalance(text, *contact.balance);
}

void describePreload(std::ostream& text, const simulation::PreloadResult& preload) {
  text << "tension " << rounded(preload.force) << ", shortened by " << rounded(preload.shortening);
}

void describeResults(std::ostream& text, const RunResult& result) {
  std::vector<simulation::BodyResult> elastic;
  std::copy_if(result.bodies.begin(), result.bodies.end(), std::back_inserter(elastic),
               [](const simulation::BodyResult& body) { return body.isElastic; });
  describeEach(text, elastic, "body", [&](const simulation::BodyResult& body) {
    text << "largest displacement " << rounded(body.largestDisplacement) << ", "
         << simulation::inWords(body.deformation) << ", von Mises stress " << rounded(body.largestStress);
  });
  describeEach(text, result.contacts, "contact",
               [&](const simulation::ContactResult& contact) { describeContact(text, contact); });
  describeEach(text, result.ties, "tied", [&](const simulation::TieResult& tie) {
    text << counted(tie.nodes, "node") << ", force " << rounded(lengthOf(tie.resultant))
         << ", largest traction " << rounded(tie.largestTraction) << "; " << tie.balance.coupling;
    if (!tie.note.empty())
      text << noteIndent << tie.note;
    addBalance(text, tie.balance);
  });
  describeEach(text, result.preloads, "bolt",
               [&](const simulation::PreloadResult& preload) { describePreload(text, preload); });
  for (const simulation::HoldResult& hold : result.holds)
    text << "  held        " << hold.motion << ": held at (" << rounded(hold.place[0]) << ", "
         << rounded(hold.place[1]) << ", " << rounded(hold.place[2]) << "), which takes a force of "
         << rounded(lengthOf(hold.force)) << '\n';
}

/// Components that are round-off beside the largest force of a support are 0.
void describeSupports(std::ostream& text, std::vector<simulation::SupportResult> supports) {
  double largest = 0;
  for (simulation::SupportResult& support : supports) {
    largest = std::max(largest, lengthOf(support.force));
    support.name = support.body + ", " + support.name;
  }
  constexpr double roundOff = 1e-9;
  describeEach(text, supports, "support", [&](const simulation::SupportResult& support) {
    text << "force (";
    for (const double& part : support.force)
      text << (&part == support.force.data() ? "" : ", ")
           << rounded(std::abs(part) > roundOff * largest ? part : 0);
    text << ')';
  });
}

void describeCosts(std::ostream& text, const RunResult& result) {
  const bool isLastOfMany = result.target.has_value();
  text << "  time        " << (isLastOfMany ? "last mesh: " : "") << "assembly "
       << seconds(result.times.assembly) << ", setup " << seconds(result.solve.times.setup);
  if (result.start)
    text << ", start " << seconds(result.start->seconds);
  text << ", solve " << seconds(result.solve.times.solve) << ", recovery " << seconds(result.times.recovery);
  if (result.error)
    text << ", error estimate " << seconds(result.times.errorEstimate);
  text << ", output " << seconds(result.times.output)
       << (isLastOfMany ? "; total of all meshes " : "; total ") << seconds(result.times.total)
       << "\n  memory      " << bytes(result.solve.peakBytes) << " at most over all ranks, of which factors "
       << bytes(result.solve.factorBytes) << '\n';
}

} // namespace

std::string summary(const RunResult& result) {
  std::ostringstream text;
  describeProblem(text, result);
  describeSolution(text, result);
  describeAccuracy(text, result);
  describeResults(text, result);
  describeSupports(text, result.supports);
  describeCosts(text, result);
  text << "  status      " << simulation::statusOf(result) << ": " << result.reason << '\n';
  return text.str();
}

std::string describe(const accuracy::MeshResult& mesh) {
  const double algebraic = std::isfinite(mesh.algebraic) ? mesh.algebraic : 0;
  const double absolute = std::hypot(mesh.discretisation, algebraic);
  const double scale = absolute > 0 ? mesh.relative() / absolute : 0;
  std::ostringstream text;
  text << "  mesh        order " << mesh.order << ", " << counted(mesh.unknowns, "primal unknown") << ", "
       << counted(mesh.multiplications, "product") << " with F, " << std::setprecision(2) << mesh.seconds
       << " s: ";
  if (mesh.quantity) {
    text << valueWithBar(mesh.quantity->value, mesh.quantity->discretisation + mesh.quantity->algebraic)
         << '\n';
    return text.str();
  }
  text << "estimated error " << percent(mesh.relative()) << " (" << percent(scale * mesh.discretisation)
       << " of the mesh, "
       << (std::isfinite(mesh.algebraic) ? percent(scale * algebraic) + " of the iteration"
                                         : "that of the iteration not measured")
       << ")\n";
  return text.str();
}

std::string describe(const simulation::StepResult& step) {
  std::ostringstream text;
  text << "  step        " << step.name << ": " << counted(step.multiplications, "product")
       << " with F, strain energy " << rounded(step.strainEnergy) << ", work of the loads "
       << rounded(step.loadWork);
  if (step.dissipation != 0)
    text << ", dissipation " << rounded(step.dissipation);
  text << '\n';
  for (const simulation::ContactResult& contact : step.contacts) {
    text << "                " << contact.name << ": force " << rounded(contact.force);
    if (contact.friction) {
      const auto& [x, y, z] = contact.friction->tangentialForce;
      text << ", friction (" << rounded(x) << ", " << rounded(y) << ", " << rounded(z) << "), sticks on "
           << rounded(contact.friction->stickArea) << ", slips on " << rounded(contact.friction->slipArea);
    }
    text << '\n';
  }
  for (const simulation::PreloadResult& preload : step.preloads) {
    text << "                " << preload.name << ": ";
    describePreload(text, preload);
    text << '\n';
  }
  return text.str();
}

} // namespace epafi::drivers
