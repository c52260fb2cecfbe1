#pragma once

/// One scene from what it says to its solution and what follows from it.

#include "epafi/simulation/AccuracyParameters.hpp"

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/Scene.hpp"
#include "epafi/simulation/RunResult.hpp"

#include <Teuchos_ParameterList.hpp>

#include <functional>
#include <memory>
#include <optional>

namespace epafi::simulation {

struct SceneRun;
struct StepsDone;

/// A run was stopped where nothing of the mesh at hand is worth keeping.
class Interrupted : public Error {
public:
  using Error::Error;
};

/// Goes along with a run: looks on, may stop it, may know where to start.
class RunCompanion : public qp::Observer {
public:
  /// Called when the problem is assembled, before anything is factorised. Returns λ to start from, or null.
  /// Collective; may throw what all ranks agree on.
  virtual RCP<const Vector> begin(const decomposition::DecomposedProblem& /*problem*/) {
    return Teuchos::null;
  }
  /// Called when Gmsh begins on the next mesh of a series.
  virtual void meshing() {}
  /// Called when all is ready for the iteration. Likewise.
  virtual void beforeIteration() {}
  /// The load steps that an earlier run has done, on all ranks alike; null: none.
  [[nodiscard]] virtual const StepsDone* stepsDone() const { return nullptr; }
  /// Called when one more load step is solved. Collective.
  virtual void stepDone(const StepsDone& /*done*/) {}
};

/// The schema of a whole XML file: the scene, and the sublists Solver and Accuracy.
Teuchos::ParameterList driverSchema();

/// A solved scene. Heap members keep their addresses: the solver refers to the problem.
struct SceneRun {
  scene::Scene scene;
  std::unique_ptr<model::Decomposition> decomposition;
  std::unique_ptr<ContactSolver> solver;
  fetidp::ContactSolution solution;
  std::optional<accuracy::ErrorEstimate> error; ///< if asked for, as it was estimated
  Evaluation evaluation;
  RunResult result; ///< complete but for the times of output and of all

  /// Divides the estimated discretisation error by its effectivity. Precondition: `error`.
  void correctEstimate(double effectivity);
  /// Divides the estimated error of the quantity by the square of the effectivity, and takes its bar from a
  /// loop that has seen other meshes. Precondition: `result.quantity`.
  void correctQuantity(double effectivity, double bar);
  /// Refers to this run.
  [[nodiscard]] SolvedScene solved() const { return {scene, *decomposition, solution}; }
};

/// What a run can start from and what it is to tell.
struct RunOptions {
  bool estimatesError = false;
  bool requiresSmall = false;    ///< displacements, see Deformation::large; else they leave a doubt
  bool bound = false;            ///< whether to bound energy and error
  QuantityParameters quantity{}; ///< needs the estimate, and has it made
  const SceneRun* coarser =
      nullptr;              ///< the same scene on a coarser mesh: its solution is where this run starts
  fetidp::RunFacts facts{}; ///< what the solve is for, and from which size on it may look for a coarser mesh
  RunCompanion* companion = nullptr;
  /// How meshes of files lie on several ranks, where `bodies` does not say: whole if runs are to be compared.
  /// A displacement at a point and a bound want them whole, and have them.
  model::Meshes meshes = model::Meshes::whole;
  /// Bodies that are meshed and cut already, which the run takes; null: as the scene says.
  std::vector<model::BodyLayout>* bodies = nullptr;
  /// Changes data of the problem before anything is factorised. Collective; may be null.
  std::function<void(model::Decomposition&)> changeData{};
};

/// Decomposes, assembles and solves.
/// \param solverParameters  the list Solver, validated or not
/// Collective.
/// \throws InputError, SolvabilityError or Error, the same on all ranks.
SceneRun solveScene(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                    const RCP<const Comm>& comm, const RunOptions& options = {});

/// Solves the problem that a run is set up for once more, with the data that its decomposition has now, from
/// its last solution. \param options  as then; no quantity is asked for. Collective. \throws as solveScene.
void solveAgain(SceneRun& run, const RunOptions& options);

} // namespace epafi::simulation
