#pragma once

/// A scene solved as accurately as was asked for: on finer and finer meshes, each run from the last one's solution.

#include "AccuracyParameters.hpp"
#include "SceneRun.hpp"

#include <functional>
#include <vector>

namespace epafi::drivers {

/// What is told of a mesh once it is solved on.
struct Level {
  GlobalOrdinal unknowns = 0;     ///< primal dimension
  int multiplications = 0;        ///< products with F
  double relativeError = 0;       ///< estimated, of mesh and iteration together
  double discretisationError = 0; ///< estimated, in the energy norm
  double algebraicError = 0;      ///< likewise
  double seconds = 0;             ///< of the whole level
};

struct AccurateRun {
  SceneRun run; ///< on the last mesh
  std::vector<Level> levels;
  bool isMet = false; ///< whether the estimate is below the target
  std::string reason; ///< if not: why no finer mesh was made
};

/// Refines the scene until the estimated relative error is at most the target, or no finer mesh is allowed. Its report gets
/// the list Levels, and the status says whether the target is met.
/// \param solverParameters  the list Solver; its tolerance is 'balanced' unless it gives one
/// \param tell              is told of every level; may be empty
/// Precondition: accuracy.target > 0. Collective. \throws as solveScene.
AccurateRun solveToTarget(scene::Scene scene, Teuchos::ParameterList solverParameters,
                          const AccuracyParameters& accuracy, const RCP<const Comm>& comm,
                          RunCompanion* companion, const std::function<void(const Level&)>& tell);

} // namespace epafi::drivers
