#pragma once

/// What a file or a list asks to be solved, as all doors to a run take it.

#include "epafi/accuracy/AccuracyLoop.hpp"
#include "epafi/scene/StepReader.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <Teuchos_ParameterList.hpp>

#include <functional>
#include <string>
#include <vector>

namespace epafi::drivers {

struct Task {
  scene::Scene scene;
  std::vector<scene::Step> steps;
  Teuchos::ParameterList solver{}; ///< validated
  simulation::AccuracyParameters accuracy{};
  /// Of a deck: there are no finer meshes, and a target is what the error on its own one is judged by.
  bool keepsMesh = false;
  [[nodiscard]] bool refines() const { return accuracy.target > 0 && !keepsMesh; }
};

/// \param given  all of a scene, in the schema of simulation::driverSchema()
/// \param file   where it is from; meshes lie relative to it
/// \throws InputError or SolvabilityError, as the scene's readers, and for what does not go together. Not
/// collective.
Task readTask(const Teuchos::ParameterList& given, const std::string& file);

/// Who is told of stages of a run, when the next one is to begin; either may be null.
struct StageTellers {
  std::function<void(const accuracy::MeshResult&, simulation::SceneRun&)> mesh;
  std::function<void(simulation::SceneRun&)> step;
};

/// On the scene's own mesh, or on finer ones until the error is small enough, or step by step; of a deck that
/// misses its target that is the status. Collective.
/// \throws as simulation::solveScene.
simulation::SceneRun solveTask(const Task& task, const RCP<const Comm>& comm,
                               simulation::RunCompanion* companion, const StageTellers& tell);

} // namespace epafi::drivers
