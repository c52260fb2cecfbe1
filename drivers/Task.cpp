#include "Task.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/deck/DeckModel.hpp"
#include "epafi/scene/SceneReader.hpp"
#include "epafi/simulation/AccurateRun.hpp"
#include "epafi/simulation/StepRun.hpp"

#include <utility>

namespace epafi::drivers {
namespace {

/// Steps go on one mesh, to no number with a bar.
void requireOneOfBoth(const std::string& file, const Task& task) {
  const simulation::AccuracyParameters& accuracy = task.accuracy;
  const bool hasQuantity = accuracy.quantity.kind != simulation::QuantityParameters::Kind::none;
  if (accuracy.target > 0 && hasQuantity && task.keepsMesh)
    throw InputError(file +
                     ": a deck is solved on its own mesh, on which a Quantity has its bar whatever the "
                     "Target; leave out one of them.");
  if (!task.steps.empty() && accuracy.bound)
    throw InputError(file + ": guaranteed bounds are not there for load steps; leave out \"Bound\".");
  if (!task.steps.empty() && (task.refines() || hasQuantity))
    throw InputError(file +
                     ": list \"Steps\" cannot go together with a Target or a Quantity in list "
                     "\"Accuracy\": load steps are solved on the mesh that is given; leave out one of them.");
}

/// A run that stays on its mesh, by its estimated error.
void judge(double target, simulation::RunResult& result) {
  if (result.status != simulation::RunStatus::converged || !result.error ||
      result.error->relative() <= target)
    return;
  result.status = simulation::RunStatus::targetMissed;
  result.reason = "the estimated error is " + text(100 * result.error->relative()) + " %, and " +
                  text(100 * target) +
                  " % was asked; a deck is solved on its own mesh: refine it where it comes from";
}

} // namespace

Task readTask(const Teuchos::ParameterList& given, const std::string& file) {
  const Teuchos::ParameterList list = validated(given, simulation::driverSchema(), file);
  Task task{.scene = scene::readScene(given, file), .steps = {}};
  task.steps = scene::readSteps(given, file, task.scene);
  task.solver = list.sublist("Solver");
  task.accuracy = simulation::AccuracyParameters::from(list.sublist("Accuracy"));
  task.keepsMesh = deck::isDeck(file);
  requireOneOfBoth(file, task);
  return task;
}

simulation::SceneRun solveTask(const Task& task, const RCP<const Comm>& comm,
                               simulation::RunCompanion* companion, const StageTellers& tell) {
  const simulation::AccuracyParameters& accuracy = task.accuracy;
  const simulation::RunOptions options{.estimatesError = accuracy.estimate || accuracy.target > 0,
                                       .requiresSmall = accuracy.requiresSmall,
                                       .bound = accuracy.bound,
                                       .quantity = accuracy.quantity,
                                       .facts = {.coarserFrom = accuracy.coarserFrom},
                                       .companion = companion,
                                       .meshes = model::Meshes::pieces};
  if (task.refines())
    return std::move(
        simulation::solveToTarget(task.scene, task.solver, accuracy, comm, companion, tell.mesh).run);
  simulation::SceneRun run =
      task.steps.empty()
          ? simulation::solveScene(task.scene, task.solver, comm, options)
          : simulation::solveSteps(task.scene, task.steps, task.solver, comm, options, tell.step);
  if (accuracy.target > 0)
    judge(accuracy.target, run.result);
  return run;
}

} // namespace epafi::drivers
