#include "Task.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/deck/DeckModel.hpp"
#include "epafi/output/Checkpoint.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"
#include "epafi/simulation/AccurateRun.hpp"
#include "epafi/simulation/StepRun.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi::drivers {
namespace {

/// Steps go on one mesh, to no number with a bar.
void requireOneOfBoth(const std::string& file, const Task& task) {
  const simulation::AccuracyParameters& accuracy = task.accuracy;
  const bool hasQuantity = accuracy.quantity.kind != simulation::QuantityParameters::Kind::none;
  if (!task.steps.empty() && accuracy.bound)
    throw InputError(file + ": guaranteed bounds are not there for load steps; leave out \"Bound\".");
  if (!task.steps.empty() && ((accuracy.target > 0 && task.deck.empty()) || hasQuantity))
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

/// How large the error of a run is, or of its worst step; NaN: not known.
double errorOf(const simulation::RunResult& result) {
  if (result.quantity && !result.quantity->failure.empty())
    return std::numeric_limits<double>::quiet_NaN();
  if (result.quantity)
    return (result.quantity->bar + result.quantity->algebraic) / std::abs(result.quantity->value);
  double largest = result.error ? result.error->relative() : std::numeric_limits<double>::quiet_NaN();
  for (const simulation::StepResult& step : result.steps)
    largest = std::isnan(largest) || step.relativeError <= largest ? largest : step.relativeError;
  return largest;
}

/// A run that stays on its mesh, by its estimated error or the bar of what is asked for.
void judge(double target, simulation::RunResult& result) {
  const double error = errorOf(result);
  if (result.status != simulation::RunStatus::converged || error <= target)
    return;
  result.status = simulation::RunStatus::targetMissed;
  result.reason = (std::isfinite(error) ? "the estimated error is " + text(100 * error) + " %"
                   : result.quantity    ? "there is no error bar (" + result.quantity->failure + ")"
                                        : "the error is not known of all there is") +
                  (result.steps.empty() || !std::isfinite(error) ? "" : " in the worst load step") +
                  ", and " + text(100 * target) +
                  " % was asked; finer meshes would not have the nodes, steps or integration points of this "
                  "deck: refine it where it comes from";
}

} // namespace

Task readTask(const Teuchos::ParameterList& given, const std::string& file) {
  const Teuchos::ParameterList list = validated(given, simulation::driverSchema(), file);
  Task task{.scene = scene::readScene(given, file), .steps = {}};
  task.steps = scene::readSteps(given, file, task.scene);
  task.solver = list.sublist("Solver");
  task.accuracy = simulation::AccuracyParameters::from(list.sublist("Accuracy"));
  if (deck::isDeck(file))
    task.deck = file;
  requireOneOfBoth(file, task);
  if (!task.steps.empty())
    task.marks = marksOf(given, task.steps);
  return task;
}

bool refines(const Task& task, const Comm& comm) {
  if (task.accuracy.target <= 0 || task.deck.empty())
    return task.accuracy.target > 0;
  const std::vector<scene::Body>& bodies = task.scene.bodies;
  if (task.keepsMesh || !task.steps.empty() ||
      std::any_of(bodies.begin(), bodies.end(), [](const auto& body) { return body.reducedIntegration; }))
    return false;
  bool namesNodes = false;
  collectively(comm, [&] {
    if (comm.getRank() == 0)
      namesNodes = !deck::modelOf(deck::readDeck(task.deck), task.deck).groups.nodes.empty();
  });
  return maxOverRanks(comm, namesNodes ? 1 : 0) == 0;
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
  if (refines(task, *comm))
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
