#pragma once

/// A scene solved as accurately as was asked for: mesh after mesh, each run from the last one's solution.

#include "epafi/simulation/AccuracyParameters.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/accuracy/AccuracyLoop.hpp"

#include <functional>
#include <string>
#include <vector>

namespace epafi::simulation {

struct AccurateRun {
  SceneRun run; ///< on the last mesh
  accuracy::LoopResult loop;
  bool isInterrupted = false; ///< by a signal: the run is on the last mesh whose iteration ended
};

/// Refines the scene until the estimated relative error is at most the target, or no finer mesh is allowed.
/// Its result has the meshes, and the status says whether the target is met.
/// \param solverParameters  the list Solver; its tolerance is 'balanced' unless it gives one
/// \param tell  is told of every mesh before the next one is made, with its run, whose result says what is
/// reached so far, with the status running; may be empty
/// Precondition: accuracy.target > 0. Collective. \throws as solveScene.
AccurateRun solveToTarget(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                          const AccuracyParameters& accuracy, const RCP<const Comm>& comm,
                          RunCompanion* companion,
                          const std::function<void(const accuracy::MeshResult&, SceneRun&)>& tell);

} // namespace epafi::simulation
