#include "HeterogeneityCase.hpp"

#include "SceneRun.hpp"

#include "epafi/qp/SpectrumEstimate.hpp"

namespace epafi::drivers {

HeterogeneityRun runHeterogeneous(const scene::Scene& scene, const std::string& use,
                                  const RCP<const Comm>& comm) {
  Teuchos::ParameterList parameters;
  parameters.sublist("Adaptive Constraints").set("Use", use);
  const SceneRun solved = solveScene(scene, parameters, comm);
  const fetidp::DualProblem& dual = solved.solver->dualProblem();
  const qp::SpectrumEstimate spectrum = qp::estimateSpectrum(*dual.hessian(), dual.preconditioner());
  HeterogeneityRun run;
  run.converged = solved.solver->report().status == qp::Status::converged;
  run.products = solved.solver->report().counts.hessianMultiplications;
  run.constraints = solved.report.sublist("Problem").get<int>("Adaptive Constraints");
  run.smallest = spectrum.smallest;
  run.largest = spectrum.largest;
  run.energy = solved.solution.energy;
  run.setup = solved.solver->times().setup;
  run.solve = solved.solver->times().solve;
  return run;
}

} // namespace epafi::drivers
