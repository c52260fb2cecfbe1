#include "SceneRun.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

namespace epafi::drivers {

Teuchos::ParameterList driverSchema() {
  Teuchos::ParameterList schema = scene::sceneSchema();
  schema.sublist("Solver", false, "How the problem is solved; the defaults suit most scenes.")
      .setParameters(ContactSolver::validParameters());
  return schema;
}

SceneRun solveScene(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                    const RCP<const Comm>& comm, qp::Observer* observer) {
  SceneRun run;
  run.started = Teuchos::Time::wallTime();
  run.scene = scene;
  run.solver = std::make_unique<ContactSolver>(solverParameters);
  run.decomposition = std::make_unique<decomposition::Decomposition>(decomposition::decompose(scene, comm));
  const double assembly = maxOverRanks(*comm, Teuchos::Time::wallTime() - run.started);
  run.solver->setup(run.decomposition->problem);
  run.solution = run.solver->solve(nullptr, observer);
  const double solved = Teuchos::Time::wallTime();
  run.evaluation = output::evaluate(run.solved());
  run.report = run.solver->reportList(run.solution);
  output::addResults(run.solved(), run.evaluation, run.report);
  const double evaluation = maxOverRanks(*comm, Teuchos::Time::wallTime() - solved);
  run.report.sublist("Time")
      .set("Assembly", assembly)
      .set("Recovery", run.solver->times().recovery + evaluation);
  run.report.sublist("Problem").set("Title", scene.title);
  return run;
}

} // namespace epafi::drivers
