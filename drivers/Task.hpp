#pragma once

/// What a file or a list asks to be solved, as all doors to a run take it.

#include "epafi/accuracy/AccuracyLoop.hpp"
#include "epafi/scene/StepReader.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <Teuchos_ParameterList.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace epafi::drivers {

struct Task {
  scene::Scene scene;
  std::vector<scene::Step> steps;
  Teuchos::ParameterList solver{}; ///< validated
  simulation::AccuracyParameters accuracy{};
  /// Of a scene with load steps: numbers that tell what is solved from other scenes, of the scene without
  /// them and of each step (simulation::StepsDone::marks).
  std::vector<std::uint64_t> marks{};
  std::string deck{};     ///< the file, if it is one
  bool keepsMesh = false; ///< whether it has to be solved on its own mesh whatever the target
};

/// \param given  all of a scene, in the schema of simulation::driverSchema()
/// \param file   where it is from; meshes lie relative to it
/// \throws InputError or SolvabilityError, as the scene's readers, and for what does not go together. Not
/// collective.
Task readTask(const Teuchos::ParameterList& given, const std::string& file);

/// Whether there are finer meshes to come to a target: of a deck where all that it names are faces and
/// elements, no body is integrated by fewer points, and there is one step. Otherwise its target is what the
/// error on its own mesh is judged by. Collective.
bool refines(const Task& task, const Comm& comm);

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
