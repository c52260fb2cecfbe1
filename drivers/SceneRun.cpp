#include "SceneRun.hpp"

#include "CoarserScene.hpp"
#include "RowWords.hpp"

#include "epafi/accuracy/ContactTransfer.hpp"
#include "epafi/accuracy/Doubts.hpp"
#include "epafi/accuracy/Transfer.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/model/ClusterSize.hpp"
#include "epafi/output/Slab.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::drivers {

Teuchos::ParameterList driverSchema() {
  Teuchos::ParameterList schema = scene::sceneSchema();
  schema.sublist("Solver", false, "How the problem is solved; the defaults suit most scenes.")
      .setParameters(ContactSolver::validParameters());
  AccuracyParameters::addTo(schema);
  return schema;
}

double SceneRun::relativeError() const {
  const double algebraic = std::isfinite(solution.algebraicError) ? solution.algebraicError : 0;
  const double absolute = std::hypot(error->discretisation, algebraic);
  const double whole = std::hypot(error->energyNorm, absolute);
  return whole > 0 ? absolute / whole : 0;
}

void SceneRun::correctEstimate(double effectivity) {
  correction *= effectivity;
  error->discretisation /= effectivity;
  for (std::vector<double>& elements : error->elements)
    for (double& squared : elements)
      squared /= effectivity * effectivity;
  for (std::vector<double>& cells : evaluation.errors)
    for (double& cell : cells)
      cell /= effectivity;
  report.sublist("Accuracy")
      .set("Discretisation Error", error->discretisation)
      .set("Relative Error", relativeError())
      .set("Effectivity", effectivity);
}

void SceneRun::correctQuantity(double effectivity, double bar) {
  quantity->error /= effectivity * effectivity;
  quantity->bar = bar;
  report.sublist("Quantity")
      .set("Estimated Error", quantity->error)
      .set("Error Bar", quantity->bar + quantity->algebraic);
}

namespace {

/// The solution on a coarser mesh as λ of a run that is set up; null if that has no use for it. What goes
/// wrong is no matter: there are other starts. Collective.
RCP<Vector> startFrom(const SceneRun& coarser, const SceneRun& run) try {
  const RCP<Vector> start =
      run.solver->startFrom(accuracy::interpolate(*coarser.decomposition, coarser.solution.displacement,
                                                  *run.decomposition, accuracy::NodesOf::interfaces));
  if (!start.is_null())
    accuracy::transferContact(*coarser.decomposition, *coarser.solution.multiplier, *run.decomposition,
                              *start);
  return start;
} catch (const Error&) { // on all ranks
  return Teuchos::null;
}

/// Passes on the wish to stop, and nothing else.
class Silent final : public RunCompanion {
public:
  explicit Silent(RunCompanion* of) : of_(of) {}
  void step(const qp::StepRecord& /*record*/) override {}
  [[nodiscard]] bool wantsToStop() override { return of_ != nullptr && of_->wantsToStop(); }

private:
  RunCompanion* of_;
};

/// Whether a run looks for the contact zone on a coarser mesh first. Membranes are solved in less time than
/// it takes.
bool beginsOnCoarserMesh(const decomposition::DecomposedProblem& problem, const RunOptions& options) {
  return options.coarser == nullptr && problem.components > 1 && problem.numInequalities > 0 &&
         problem.primalDimension >= options.coarserFrom;
}

/// From a good start active sets need the fewest products where bodies are held, too; from none MPRGP does.
Teuchos::ParameterList chosenFor(const decomposition::DecomposedProblem& problem,
                                 Teuchos::ParameterList parameters, const RunOptions& options) {
  const bool isOpen = parameters.get<std::string>("Algorithm", "auto") == "auto",
             isPreconditioned =
                 parameters.sublist("Preconditioner").get<std::string>("Type", "dirichlet") != "none";
  if (isOpen && isPreconditioned && beginsOnCoarserMesh(problem, options))
    parameters.set("Algorithm", std::string("active set"));
  return parameters;
}

/// A few subdomains need no clusters, which cost products. Ranks keep the subdomains that they have. Not
/// collective.
void joinClusters(CoarserScene& coarser, int numRanks) {
  GlobalOrdinal number = 0;
  for (const model::BodyLayout& body : coarser.bodies)
    number += body.partition->numParts();
  for (scene::Body& body : coarser.scene.bodies)
    if (!model::clustersPay(scene::dimensionOf(body.physics), number, numRanks))
      body.decomposition.cluster = 0;
}

/// Where active sets are to find a contact zone, that of a coarser mesh leaves them little to find. Before
/// the run is set up, and without its factors: there is memory for one set of them. What goes wrong there is
/// no matter. Collective.
std::optional<SceneRun> solveOnCoarserMesh(SceneRun& run, const Teuchos::ParameterList& solverParameters,
                                           const RCP<const Comm>& comm, const RunOptions& options) {
  constexpr double enough = 1e-4; // meshes differ by more
  if (run.solver->algorithmFor(run.decomposition->problem) != fetidp::Algorithm::activeSets ||
      !beginsOnCoarserMesh(run.decomposition->problem, options))
    return std::nullopt;
  const double began = Teuchos::Time::wallTime();
  try {
    std::optional<CoarserScene> coarser = coarserScene(run.scene, run.decomposition->bodies, *comm);
    if (!coarser)
      return std::nullopt;
    joinClusters(*coarser, comm->getSize());
    Teuchos::ParameterList parameters(solverParameters);
    parameters.set("Tolerance", enough);
    Silent silent(options.companion);
    SceneRun coarse = solveScene(
        coarser->scene, parameters, comm,
        {.coarserFrom = 4 * options.coarserFrom, .companion = &silent, .bodies = &coarser->bodies});
    run.start = {coarser->means, coarse.decomposition->problem.primalDimension,
                 coarse.solver->report().counts.hessianMultiplications, coarse.solution.energy,
                 maxOverRanks(*comm, Teuchos::Time::wallTime() - began)};
    coarse.solver.reset();
    return coarse;
  } catch (const Error&) { // on all ranks
    return std::nullopt;
  }
}

/// A guess of the discretisation error relative to the solution, from nothing but the number of nodes: h of
/// even meshes of bodies of size 1, as edges and borders of contact leave it to any order.
double guessedError(const SceneRun& run) {
  const decomposition::DecomposedProblem& problem = run.decomposition->problem;
  const auto& bodies = run.scene.bodies;
  const double nodes =
      static_cast<double>(problem.primalDimension) / problem.components / static_cast<double>(bodies.size());
  return std::pow(nodes, -1.0 / scene::dimensionOf(bodies.front().physics));
}

/// Of each contact: the most by which a closed node has changed its gap. Collective.
std::vector<double> closingOf(const SceneRun& run) {
  std::vector<double> closing;
  const Comm& comm = *run.decomposition->problem.comm;
  for (std::size_t c = 0; c < run.decomposition->contacts.size(); ++c) {
    const contact::ContactLayout& layout = run.decomposition->contacts[c];
    const output::ContactState& state = run.evaluation.contacts[c];
    const std::vector<std::size_t> own = layout.ownRows();
    const auto first =
        static_cast<std::size_t>(output::evenShare(static_cast<GlobalOrdinal>(own.size()), comm).first);
    double most = 0;
    for (std::size_t i = 0; i < state.gap.size(); ++i)
      if (state.force[i] > 0)
        most = std::max(most, std::abs(layout.gaps[own[first + i]] - state.gap[i]));
    closing.push_back(maxOverRanks(comm, most));
  }
  return closing;
}

/// How far the iteration has to go. `looked` becomes the last estimate. Keeps references.
fetidp::ErrorBalance balanceOf(const SceneRun& run, std::optional<accuracy::ErrorEstimator>& estimator,
                               std::optional<accuracy::ErrorEstimate>& looked, const RunOptions& options) {
  fetidp::ErrorBalance balance;
  balance.fraction = run.solver->algebraicFraction();
  balance.estimate = [&](std::span<const Eigen::VectorXd> u) {
    looked = (*estimator)(u);
    return looked->toBalance();
  };
  const double guess = std::min(guessedError(run), 0.1);
  balance.firstLook =
      0.2 * balance.fraction * guess; // without any coupling the energy is some times the solution's
  if (options.coarser != nullptr && options.coarser->error) // of linear elements it is halved at best
    balance.expected = 0.5 * options.coarser->error->discretisation * options.coarser->correction;
  else if (run.start)
    balance.expected = guess * std::sqrt(2 * std::abs(run.start->energy));
  return balance;
}

} // namespace

SceneRun solveScene(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                    const RCP<const Comm>& comm, const RunOptions& options) {
  SceneRun run;
  run.started = Teuchos::Time::wallTime();
  run.scene = scene;
  const model::Meshes meshes = options.quantity.point.empty() ? options.meshes : model::Meshes::whole;
  run.decomposition = std::make_unique<model::Decomposition>(
      options.bodies == nullptr ? model::decompose(scene, comm, meshes)
                                : model::decompose(scene, std::move(*options.bodies), comm));
  run.solver =
      std::make_unique<ContactSolver>(chosenFor(run.decomposition->problem, solverParameters, options));
  std::optional<QuantityOfScene> quantity;
  if (options.quantity.kind != QuantityParameters::Kind::none)
    quantity.emplace(options.quantity, run.scene, *run.decomposition);
  const bool estimatesError = options.estimatesError || quantity;
  const double assembly = maxOverRanks(*comm, Teuchos::Time::wallTime() - run.started);
  RCP<const Vector> start;
  if (options.companion != nullptr)
    start = options.companion->begin(run.decomposition->problem);
  std::optional<SceneRun> coarse;
  if (start.is_null())
    coarse = solveOnCoarserMesh(run, solverParameters, comm, options);
  const auto inWords = [&run](const auto& work) {
    try {
      return work();
    } catch (const fetidp::ContradictionError& error) { // on all ranks
      throw inWordsOf(*run.decomposition, error);
    }
  };
  inWords([&] { run.solver->setup(run.decomposition->problem); });
  if (options.companion != nullptr)
    options.companion->beforeIteration();
  std::optional<accuracy::ErrorEstimator> estimator;
  if (estimatesError || run.solver->isBalanced())
    estimator.emplace(run.scene, *run.decomposition);
  const double began = Teuchos::Time::wallTime();
  if (const SceneRun* const coarser = coarse ? &*coarse : options.coarser;
      coarser != nullptr && start.is_null())
    start = startFrom(*coarser, run);
  if (run.start)
    run.start->seconds += maxOverRanks(*comm, Teuchos::Time::wallTime() - began);
  coarse.reset();
  const fetidp::ErrorBalance balance = balanceOf(run, estimator, run.error, options);
  run.solution = inWords([&] {
    return run.solver->solve(start.get(), options.companion, run.solver->isBalanced() ? &balance : nullptr);
  });
  const double solved = Teuchos::Time::wallTime();
  if (!estimatesError)
    run.error.reset(); // the iteration's last look, if it took one
  else if (!run.solution.isEstimated)
    run.error = (*estimator)(run.solution.displacement);
  if (quantity)
    run.quantity = (*quantity)(*run.solver, run.solved(), *estimator, run.error->energyNorm);
  const double estimated = Teuchos::Time::wallTime();
  run.evaluation = output::evaluate(run.solved(), run.error ? &*run.error : nullptr);
  run.report = run.solver->reportList(run.solution);
  output::addResults(run.solved(), run.evaluation, run.report);
  const double evaluation = maxOverRanks(*comm, Teuchos::Time::wallTime() - estimated);
  run.report.sublist("Time")
      .set("Assembly", assembly)
      .set("Recovery", run.solver->times().recovery + evaluation);
  if (run.error) {
    run.report.sublist("Time").set("Error Estimate", maxOverRanks(*comm, estimated - solved));
    run.report.sublist("Accuracy")
        .set("Energy Norm", run.error->energyNorm)
        .set("Discretisation Error", run.error->discretisation)
        .set("Relative Error", run.relativeError());
  }
  if (const std::string text = accuracy::doubts(run.scene, *run.decomposition, closingOf(run)); !text.empty())
    run.report.sublist("Accuracy").set("Doubts", text);
  if (run.start) {
    run.report.sublist("Start")
        .set("Mesh", run.start->means)
        .set("Primal Dimension", run.start->unknowns)
        .set("Hessian Multiplications", run.start->multiplications);
    run.report.sublist("Time").set("Start", run.start->seconds);
  }
  if (run.quantity) {
    Teuchos::ParameterList& list = run.report.sublist("Quantity");
    list.set("Name", run.quantity->name).set("Value", run.quantity->value);
    if (run.quantity->failure.empty())
      list.set("Error Bar", run.quantity->bar + run.quantity->algebraic)
          .set("Estimated Error", run.quantity->error)
          .set("Hessian Multiplications", run.quantity->multiplications);
    else
      list.set("Reason", run.quantity->failure);
  }
  run.report.sublist("Problem").set("Title", scene.title);
  return run;
}

} // namespace epafi::drivers
