#pragma once

/// A scene in load steps: factors made once, what friction has slipped kept from step to step.

#include "epafi/scene/StepReader.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <functional>
#include <vector>

namespace epafi::simulation {

/// Solves one step after the other; what is returned is the last step, with all of them in its result. A step
/// that does not converge is the last one.
/// \param steps  at least one
/// \param tell   called after each step but the last with the run so far, whose result has the steps that it
/// went through and the status running; may be null
/// Collective. \throws as solveScene.
SceneRun solveSteps(const scene::Scene& scene, const std::vector<scene::Step>& steps,
                    const Teuchos::ParameterList& solverParameters, const RCP<const Comm>& comm,
                    const RunOptions& options, const std::function<void(SceneRun&)>& tell);

} // namespace epafi::simulation
