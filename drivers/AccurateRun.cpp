#include "AccurateRun.hpp"

#include "RunWatch.hpp"
#include "SceneLevels.hpp"

#include "epafi/base/Collective.hpp"

#include <memory>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

using accuracy::MeshResult;

void report(AccurateRun& result, double target) {
  Teuchos::ParameterList& list = result.run.report;
  for (std::size_t i = 0; i < result.loop.meshes.size(); ++i) {
    const MeshResult& mesh = result.loop.meshes[i];
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
  list.sublist("Accuracy").set("Target", target);
  if (!result.loop.choice.empty())
    list.sublist("Accuracy").set("Choice of Order", result.loop.choice);
  const std::string status = result.isInterrupted ? "Interrupted" : "TargetMissed";
  const std::string what = result.loop.meshes.back().quantity
                               ? "the error bar of the " + result.run.quantity->name
                               : "the estimated error";
  std::ostringstream reason;
  reason.precision(3);
  if (result.loop.isMet) {
    reason << what << " is " << 100 * result.loop.meshes.back().relative() << " %, at most the "
           << 100 * target << " % that was asked for";
    list.sublist("Status")
        .set("Converged", true)
        .set("Status", std::string("Converged"))
        .set("Reason", reason.str());
    return;
  }
  reason << what << " is " << 100 * result.loop.meshes.back().relative() << " %, and " << 100 * target
         << " % was asked for: " << result.loop.reason;
  if (result.loop.isEndless)
    reason << "; round the edge, or ask for the force";
  list.sublist("Status").set("Converged", false).set("Status", status).set("Reason", reason.str());
}

} // namespace

AccurateRun solveToTarget(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                          const AccuracyParameters& accuracy, const RCP<const Comm>& comm,
                          RunCompanion* companion, const std::function<void(const MeshResult&)>& tell) {
  const bool isLocal = accuracy.refinement == AccuracyParameters::Refinement::local;
  const std::unique_ptr<SceneLevels> levels = levelsOf(scene, solverParameters, accuracy, comm, companion);
  AccurateRun result;
  std::vector<MeshResult> done;
  const auto note = [&](const MeshResult& mesh) {
    done.push_back(mesh);
    done.back().elements = {};
    if (tell)
      tell(mesh);
  };
  try {
    result.loop = refineToTarget(*levels,
                                 {.target = accuracy.target,
                                  .maxMeshes = accuracy.maxLevels,
                                  .maxUnknowns = accuracy.maxUnknowns,
                                  .maxSeconds = accuracy.maxSeconds,
                                  .maxBytes = minOverRanks(*comm, accuracy.maxBytes),
                                  .order = isLocal ? accuracy.order : 1},
                                 note);
  } catch (const Interrupted&) {
    if (done.empty())
      throw;
    result.loop.meshes = std::move(done);
    result.loop.reason =
        "a signal came before the next mesh was solved on; the results are those of the last complete one";
    result.isInterrupted = true;
  } catch (const Error& error) { // on all ranks; what was reached is not thrown away
    if (done.empty())
      throw;
    result.loop.meshes = std::move(done);
    result.loop.reason = std::string("the next mesh failed: ") + error.what();
  }
  result.run = std::move(levels->run());
  if (result.run.solver->report().status == qp::Status::interrupted) // on the first mesh
    result.isInterrupted = true;
  const MeshResult& last = result.loop.meshes.back();
  result.run.correctEstimate(last.effectivity);
  if (last.quantity)
    result.run.correctQuantity(last.effectivity, last.quantity->discretisation);
  report(result, accuracy.target);
  return result;
}

} // namespace epafi::drivers
