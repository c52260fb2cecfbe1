#include "epafi/simulation/AccurateRun.hpp"

#include "epafi/simulation/SceneLevels.hpp"

#include "epafi/accuracy/Doubts.hpp"
#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>

namespace epafi::simulation {
namespace {

using accuracy::LoopResult;
using accuracy::MeshResult;

void correct(SceneRun& run, const MeshResult& mesh) {
  run.correctEstimate(mesh.effectivity);
  if (mesh.quantity)
    run.correctQuantity(mesh.effectivity, mesh.quantity->discretisation);
}

/// How far the run has come on its way to the target.
void enter(const LoopResult& loop, double target, RunStatus status, RunResult& result) {
  result.target = {target, loop.meshes, loop.choice};
  for (MeshResult& mesh : result.target->meshes)
    mesh.elements = {};
  const MeshResult& last = loop.meshes.back();
  std::ostringstream reason;
  reason.precision(3);
  reason << (last.quantity ? "the error bar of the " + result.quantity->name : "the estimated error")
         << " is " << 100 * last.relative() << " %, ";
  if (loop.isMet)
    reason << "at most the " << 100 * target << " % that was asked for";
  else
    reason << "and " << 100 * target << " % was asked for: " << loop.reason;
  if (loop.isEndless)
    reason << "; round the edge, or ask for the force";
  result.status = status;
  result.reason = reason.str();
}

} // namespace

AccurateRun solveToTarget(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                          const AccuracyParameters& accuracy, const RCP<const Comm>& comm,
                          RunCompanion* companion,
                          const std::function<void(const MeshResult&, SceneRun&)>& tell) {
  const bool isLocal = accuracy.refinement == AccuracyParameters::Refinement::local;
  const bool locks = std::any_of(scene.bodies.begin(), scene.bodies.end(), accuracy::locks);
  const int order = accuracy.order == 0 && locks ? 2 : accuracy.order; // estimates of order 1 know too little
  const std::unique_ptr<SceneLevels> levels = levelsOf(scene, solverParameters, accuracy, comm, companion);
  if (accuracy.bound)
    levels->boundEnergies();
  AccurateRun result;
  LoopResult soFar;
  soFar.reason = "the run went on with the next mesh; if it is not under way any more it was killed";
  const auto note = [&](const MeshResult& mesh) {
    soFar.meshes.push_back(mesh);
    soFar.meshes.back().elements = {};
    SceneRun& run = levels->run();
    correct(run, mesh);
    enter(soFar, accuracy.target, RunStatus::running, run.result);
    if (tell)
      tell(mesh, run);
  };
  try {
    result.loop = refineToTarget(*levels,
                                 {.target = accuracy.target,
                                  .maxMeshes = accuracy.maxLevels,
                                  .maxUnknowns = accuracy.maxUnknowns,
                                  .maxSeconds = accuracy.maxSeconds,
                                  .maxBytes = minOverRanks(*comm, accuracy.maxBytes),
                                  .order = isLocal ? order : 1},
                                 note);
    if (isLocal && order != accuracy.order)
      result.loop.choice = "order 2, as linear elements lock where Poisson's ratio is near 0.5";
  } catch (const Interrupted&) {
    if (soFar.meshes.empty())
      throw;
    result.loop.meshes = std::move(soFar.meshes);
    result.loop.reason =
        "a signal came before the next mesh was solved on; the results are those of the last complete one";
    result.isInterrupted = true;
  } catch (const Error& error) { // on all ranks; what was reached is not thrown away
    if (soFar.meshes.empty())
      throw;
    result.loop.meshes = std::move(soFar.meshes);
    result.loop.reason = std::string("the next mesh failed: ") + error.what();
  }
  result.run = std::move(levels->run());
  if (result.run.solver->report().status == qp::Status::interrupted) // on the first mesh
    result.isInterrupted = true;
  enter(result.loop, accuracy.target,
        result.loop.isMet      ? RunStatus::converged
        : result.isInterrupted ? RunStatus::interrupted
                               : RunStatus::targetMissed,
        result.run.result);
  if (accuracy.requiresSmall)
    requireSmall(result.run.result);
  requireAllContacts(result.run.result);
  return result;
}

} // namespace epafi::simulation
