#include "Task.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/deck/DeckModel.hpp"
#include "epafi/output/Checkpoint.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"
#include "epafi/simulation/AccurateRun.hpp"
#include "epafi/simulation/StepRun.hpp"

#include <utility>

namespace epafi::drivers {
namespace {

/// Steps go on one mesh, to no number with a bar.
void requireOneOfBoth(const std::string& file, const Task& task) {
  const simulation::AccuracyParameters& accuracy = task.accuracy;
  if (accuracy.target > 0 && deck::isDeck(file))
    throw InputError(file +
                     ": a deck is solved on its own mesh: finer ones would not have its groups of nodes; "
                     "leave out the target, or refine the deck where it comes from.");
  if (!task.steps.empty() && accuracy.bound)
    throw InputError(file + ": guaranteed bounds are not there for load steps; leave out \"Bound\".");
  if (!task.steps.empty() &&
      (accuracy.target > 0 || accuracy.quantity.kind != simulation::QuantityParameters::Kind::none))
    throw InputError(file +
                     ": list \"Steps\" cannot go together with a Target or a Quantity in list "
                     "\"Accuracy\": load steps are solved on the mesh that is given; leave out one of them.");
}

std::uint64_t markOf(const Teuchos::ParameterList& list) {
  const std::string text = scene::xmlText(list);
  output::Checksum sum;
  sum.add(text.data(), text.size());
  return sum.value();
}

/// What is solved, not how.
std::vector<std::uint64_t> marksOf(Teuchos::ParameterList list, const std::vector<scene::Step>& steps) {
  const Teuchos::ParameterList all = list.sublist("Steps");
  for (const char* const other : {"Title", "Solver", "Accuracy", "Steps"})
    list.remove(other, false);
  std::vector<std::uint64_t> marks{markOf(list)};
  for (const scene::Step& step : steps)
    marks.push_back(markOf(all.sublist(step.name)));
  return marks;
}

} // namespace

Task readTask(const Teuchos::ParameterList& given, const std::string& file) {
  const Teuchos::ParameterList list = validated(given, simulation::driverSchema(), file);
  Task task{.scene = scene::readScene(given, file), .steps = {}};
  task.steps = scene::readSteps(given, file, task.scene);
  task.solver = list.sublist("Solver");
  task.accuracy = simulation::AccuracyParameters::from(list.sublist("Accuracy"));
  requireOneOfBoth(file, task);
  if (!task.steps.empty())
    task.marks = marksOf(given, task.steps);
  return task;
}

simulation::SceneRun solveTask(const Task& task, const RCP<const Comm>& comm,
                               simulation::RunCompanion* companion, const StageTellers& tell) {
  const simulation::AccuracyParameters& accuracy = task.accuracy;
  const simulation::RunOptions options{.estimatesError = accuracy.estimate,
                                       .requiresSmall = accuracy.requiresSmall,
                                       .bound = accuracy.bound,
                                       .quantity = accuracy.quantity,
                                       .facts = {.coarserFrom = accuracy.coarserFrom},
                                       .companion = companion,
                                       .meshes = model::Meshes::pieces};
  if (!task.steps.empty())
    return simulation::solveSteps(task.scene, task.steps, task.solver, comm, options, tell.step);
  if (accuracy.target > 0)
    return std::move(
        simulation::solveToTarget(task.scene, task.solver, accuracy, comm, companion, tell.mesh).run);
  return simulation::solveScene(task.scene, task.solver, comm, options);
}

} // namespace epafi::drivers
