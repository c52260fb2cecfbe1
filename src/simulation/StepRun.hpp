#pragma once

/// A scene in load steps: factors made once, what friction has slipped kept from step to step.

#include "epafi/scene/StepReader.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <functional>
#include <vector>

namespace epafi::simulation {

/// Solves one step after the other; what is returned is the last step, with all of them in its result. A step
/// that does not converge is the last one. Steps that the options' companion has done are not done again.
/// \param steps  at least one that is not done
/// \param tell   called after each step but the last with the run so far, whose result has the steps that it
/// went through and the status running; may be null
/// Collective. \throws as solveScene.
SceneRun solveSteps(const scene::Scene& scene, const std::vector<scene::Step>& steps,
                    const Teuchos::ParameterList& solverParameters, const RCP<const Comm>& comm,
                    const RunOptions& options, const std::function<void(SceneRun&)>& tell);

/// Whether a step has other multipliers than the one before, so that these are no start. Not collective.
/// \param step  from 1 on, of these
bool changesRows(const scene::Scene& scene, const std::vector<scene::Step>& steps, std::size_t step);

} // namespace epafi::simulation
