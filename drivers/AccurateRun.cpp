#include "AccurateRun.hpp"

#include "RunWatch.hpp"
#include "SceneLevels.hpp"

#include "epafi/accuracy/Doubts.hpp"
#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

using accuracy::LoopResult;
using accuracy::MeshResult;

void correct(SceneRun& run, const MeshResult& mesh) {
  run.correctEstimate(mesh.effectivity);
  if (mesh.quantity)
    run.correctQuantity(mesh.effectivity, mesh.quantity->discretisation);
}

void enterMeshes(Teuchos::ParameterList& list, const std::vector<MeshResult>& meshes) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const MeshResult& mesh = meshes[i];
    Teuchos::ParameterList& level = list.sublist("Levels").sublist("level " + std::to_string(i));
    if (mesh.quantity)
      level.set("Quantity", mesh.quantity->value)
          .set("Error Bar", mesh.quantity->discretisation + mesh.quantity->algebraic);
    level.set("Order", mesh.order)
        .set("Primal Dimension", mesh.unknowns)
        .set("Hessian Multiplications", mesh.multiplications)
        .set("Relative Error", mesh.relative())
        .set("Discretisation Error", mesh.discretisation)
        .set("Algebraic Error", mesh.algebraic)
        .set("Effectivity", mesh.effectivity)
        .set("Seconds", mesh.seconds);
  }
}

/// \param status  what the run ends with, or that it goes on
void report(SceneRun& run, const LoopResult& loop, double target, const std::string& status) {
  Teuchos::ParameterList& list = run.report;
  enterMeshes(list, loop.meshes);
  list.sublist("Accuracy").set("Target", target);
  if (!loop.choice.empty())
    list.sublist("Accuracy").set("Choice of Order", loop.choice);
  const MeshResult& last = loop.meshes.back();
  std::ostringstream reason;
  reason.precision(3);
  reason << (last.quantity ? "the error bar of the " + run.quantity->name : "the estimated error") << " is "
         << 100 * last.relative() << " %, ";
  if (loop.isMet)
    reason << "at most the " << 100 * target << " % that was asked for";
  else
    reason << "and " << 100 * target << " % was asked for: " << loop.reason;
  if (loop.isEndless)
    reason << "; round the edge, or ask for the force";
  list.sublist("Status").set("Converged", loop.isMet).set("Status", status).set("Reason", reason.str());
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
  AccurateRun result;
  LoopResult soFar;
  soFar.reason = "the run went on with the next mesh; if it is not under way any more it was killed";
  const auto note = [&](const MeshResult& mesh) {
    soFar.meshes.push_back(mesh);
    soFar.meshes.back().elements = {};
    SceneRun& run = levels->run();
    correct(run, mesh);
    report(run, soFar, accuracy.target, "Running");
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
  report(result.run, result.loop, accuracy.target,
         result.loop.isMet      ? "Converged"
         : result.isInterrupted ? "Interrupted"
                                : "TargetMissed");
  return result;
}

} // namespace epafi::drivers
