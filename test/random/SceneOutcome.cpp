#include "SceneOutcome.hpp"

#include "support/WholeRun.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <cmath>
#include <sstream>

namespace epafi::test {

scene::Scene sceneOf(const Teuchos::ParameterList& list, const std::string& folder) {
  return scene::readScene(list, folder + "/scene.xml");
}

Outcome outcomeOf(const Teuchos::ParameterList& list, const std::string& folder,
                  const RCP<const Comm>& comm) {
  Outcome outcome;
  try {
    const scene::Scene scene = sceneOf(list, folder);
    const simulation::SceneRun run = simulation::solveScene(scene, list.sublist("Solver"), comm);
    const qp::SolveReport& report = run.solver->report();
    outcome.verdict = report.status == qp::Status::converged ? Verdict::solved : Verdict::notConverged;
    outcome.reason = qp::toString(report.status) + ": " + report.reason;
    outcome.energy = run.solution.energy;
    outcome.force = run.solution.contactForce;
    outcome.products = report.counts.hessianMultiplications;
    for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body)
      outcome.displacement.push_back(deflection(run, body));
  } catch (const InputError& error) {
    outcome = {Verdict::wrongInput, error.what()};
  } catch (const SolvabilityError& error) {
    outcome = {error.kind() == SolvabilityError::Kind::notUnique ? Verdict::notUnique : Verdict::noSolution,
               error.what()};
  } catch (const std::exception& error) {
    outcome = {Verdict::notConverged, std::string("exception: ") + error.what()};
  }
  return outcome;
}

namespace {

bool agree(Verdict found, const Truth& truth) {
  switch (truth.verdict) {
  case Verdict::contradiction:
    return found == Verdict::noSolution || found == Verdict::wrongInput ||
           (truth.isFree && found == Verdict::notUnique);
  default:
    return found == truth.verdict;
  }
}

} // namespace

std::string faultOf(const Outcome& outcome, const Truth& truth, bool withPlaces) {
  std::ostringstream text;
  if (!agree(outcome.verdict, truth)) {
    text << "verdict: " << toString(outcome.verdict) << " for " << toString(truth.verdict) << " ["
         << outcome.reason << ']';
    if (outcome.verdict == Verdict::notConverged && truth.verdict == Verdict::solved)
      text << " products " << outcome.products << ", energy " << outcome.energy << " for " << truth.energy;
    return text.str();
  }
  if (truth.verdict != Verdict::solved)
    return "";
  // Iterates that were stopped at 1e-9 have jumps of that size beside the largest displacement, and an energy
  // that is off in the first order.
  constexpr double energyTolerance = 3e-6, tolerance = 1e-4;
  if (!(std::abs(outcome.energy - truth.energy) <= energyTolerance * truth.energyScale))
    text << "energy: " << outcome.energy << " for " << truth.energy << ", off by "
         << (outcome.energy - truth.energy) / truth.energyScale << "; ";
  if (truth.forceScale > 0 && !(std::abs(outcome.force - truth.force) <= tolerance * truth.forceScale))
    text << "force: " << outcome.force << " for " << truth.force << "; ";
  double difference = 0;
  for (std::size_t body = 0; withPlaces && body < truth.displacement.size(); ++body)
    if (outcome.displacement[body].size() > 0)
      difference =
          std::max(difference, (outcome.displacement[body] - truth.displacement[body]).cwiseAbs().maxCoeff());
  if (!(difference <= tolerance * truth.largest))
    text << "displacement off by " << difference / truth.largest << "; ";
  return text.str();
}

} // namespace epafi::test
