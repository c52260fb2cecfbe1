#include "AccurateRun.hpp"

#include "epafi/accuracy/Refinement.hpp"
#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <cmath>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

Level levelOf(const SceneRun& run, double seconds) {
  Level level;
  level.unknowns = run.decomposition->problem.primalDimension;
  level.multiplications = run.solver->report().counts.hessianMultiplications;
  level.relativeError = run.relativeError();
  level.discretisationError = run.error->discretisation;
  level.algebraicError = run.solution.algebraicError;
  level.seconds = seconds;
  return level;
}

/// Why no finer mesh is made; empty if one is.
std::string obstacle(const AccurateRun& result, const AccuracyParameters& accuracy) {
  const SceneRun& run = result.run;
  std::ostringstream text;
  if (run.solver->report().status != qp::Status::converged) {
    text << "the iteration did not reach its tolerance on a mesh: " << run.solver->report().reason;
  } else if (static_cast<int>(result.levels.size()) >= accuracy.maxLevels) {
    text << "\"Maximum Levels\" allows no more than " << accuracy.maxLevels << " meshes";
  } else {
    const bool isInSpace = run.decomposition->problem.components == 3;
    const double next = static_cast<double>(result.levels.back().unknowns) * (isInSpace ? 8 : 4);
    if (next > accuracy.maxUnknowns)
      text << "the next mesh would have " << next << " unknowns, and \"Maximum Unknowns\" allows "
           << accuracy.maxUnknowns;
  }
  return text.str();
}

void report(AccurateRun& result, double target) {
  Teuchos::ParameterList& list = result.run.report;
  for (std::size_t i = 0; i < result.levels.size(); ++i) {
    const Level& level = result.levels[i];
    list.sublist("Levels")
        .sublist("level " + std::to_string(i))
        .set("Primal Dimension", level.unknowns)
        .set("Hessian Multiplications", level.multiplications)
        .set("Relative Error", level.relativeError)
        .set("Discretisation Error", level.discretisationError)
        .set("Algebraic Error", level.algebraicError)
        .set("Seconds", level.seconds);
  }
  list.sublist("Accuracy").set("Target", target);
  if (result.isMet)
    return;
  std::ostringstream reason;
  reason << "the estimated error is " << 100 * result.levels.back().relativeError << " %, and "
         << 100 * target << " % was asked for: " << result.reason;
  list.sublist("Status")
      .set("Converged", false)
      .set("Status", std::string("TargetMissed"))
      .set("Reason", reason.str());
}

} // namespace

AccurateRun solveToTarget(scene::Scene scene, Teuchos::ParameterList solverParameters,
                          const AccuracyParameters& accuracy, const RCP<const Comm>& comm,
                          RunCompanion* companion, const std::function<void(const Level&)>& tell) {
  if (!solverParameters.isParameter("Tolerance") || solverParameters.getEntry("Tolerance").isDefault())
    solverParameters.set("Tolerance", std::string("balanced"));
  AccurateRun result;
  while (true) {
    const double start = Teuchos::Time::wallTime();
    RunOptions options{.estimatesError = true, .coarser = nullptr, .companion = companion};
    if (!result.levels.empty())
      options.coarser = &result.run;
    SceneRun run = solveScene(scene, solverParameters, comm, options);
    result.run = std::move(run); // the coarser one is needed no longer
    result.levels.push_back(levelOf(result.run, maxOverRanks(*comm, Teuchos::Time::wallTime() - start)));
    if (tell)
      tell(result.levels.back());
    result.isMet = result.levels.back().relativeError <= accuracy.target;
    if (!result.isMet)
      result.reason = obstacle(result, accuracy);
    if (result.isMet || !result.reason.empty())
      break;
    scene = accuracy::refined(std::move(scene));
  }
  report(result, accuracy.target);
  return result;
}

} // namespace epafi::drivers
