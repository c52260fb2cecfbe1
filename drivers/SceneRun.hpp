#pragma once

/// One scene from its parameter list to its solution, report and files: what the driver, the studies and the
/// system tests share.

#include "epafi/ContactSolver.hpp"
#include "epafi/decomposition/Decompose.hpp"
#include "epafi/output/Evaluation.hpp"
#include "epafi/scene/Scene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <filesystem>
#include <memory>

namespace epafi::drivers {

/// The schema of a whole XML file: the scene, and the sublist Solver.
Teuchos::ParameterList driverSchema();

/// A solved scene. Heap members keep their addresses: the solver refers to the problem.
struct SceneRun {
  scene::Scene scene;
  std::unique_ptr<decomposition::Decomposition> decomposition;
  std::unique_ptr<ContactSolver> solver;
  fetidp::ContactSolution solution;
  output::Evaluation evaluation;
  Teuchos::ParameterList report; ///< complete but for Time/Output and Time/Total
  double started = 0;            ///< wall time at the start

  [[nodiscard]] output::SolvedScene solved() const { return {scene, *decomposition, solution}; }
};

/// Decomposes, assembles and solves.
/// \param solverParameters  the list Solver, validated or not
/// Collective.
/// \throws InputError, SolvabilityError or Error, the same on all ranks.
SceneRun solveScene(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                    const RCP<const Comm>& comm, qp::Observer* observer = nullptr);

} // namespace epafi::drivers
