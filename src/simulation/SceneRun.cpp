#include "epafi/simulation/SceneRun.hpp"

#include "epafi/simulation/GuaranteedBound.hpp"

#include "epafi/simulation/CoarserScene.hpp"
#include "epafi/simulation/LeftOutNodes.hpp"
#include "epafi/simulation/RowWords.hpp"

#include "epafi/accuracy/ContactTransfer.hpp"
#include "epafi/accuracy/Doubts.hpp"
#include "epafi/accuracy/Transfer.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Slab.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/model/ClusterSize.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::simulation {

Teuchos::ParameterList driverSchema() {
  Teuchos::ParameterList schema = scene::sceneSchema();
  schema.sublist("Solver", false, "How the problem is solved; the defaults suit most scenes.")
      .setParameters(ContactSolver::validParameters());
  AccuracyParameters::addTo(schema);
  return schema;
}

void SceneRun::correctEstimate(double effectivity) {
  result.error->discretisation /= effectivity;
  result.error->effectivity = effectivity;
  for (std::vector<double>& cells : evaluation.errors)
    for (double& cell : cells)
      cell /= effectivity;
}

void SceneRun::correctQuantity(double effectivity, double bar) {
  result.quantity->error /= effectivity * effectivity;
  result.quantity->bar = bar;
}

namespace {

/// The solution on a coarser mesh as λ of a run that is set up; null if that has no use for it, or if it
/// cannot be carried over, of which the run's result tells: there are other starts. Collective.
RCP<Vector> startFrom(const SceneRun& coarser, SceneRun& run) try {
  const RCP<Vector> start = run.solver->startFrom(
      run.decomposition->data, accuracy::interpolate(*coarser.decomposition, coarser.solution.displacement,
                                                     *run.decomposition, accuracy::NodesOf::interfaces));
  if (!start.is_null())
    accuracy::transferContact(*coarser.decomposition, *coarser.solution.multiplier, *run.decomposition,
                              *start);
  return start;
} catch (const Error& error) { // on all ranks
  if (!run.result.start)
    run.result.start.emplace();
  run.result.start->failure = error.what();
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

/// A few subdomains need no clusters, which cost products. Ranks keep the subdomains that they have. Not
/// collective.
void joinClusters(CoarserScene& coarser, int numRanks) {
  GlobalOrdinal number = 0;
  for (const model::BodyLayout& body : coarser.bodies)
    number += body.partition->numParts();
  for (scene::Body& body : coarser.scene.bodies)
    if (!model::clustersPay(fem::dimensionOf(body.physics), number, numRanks))
      body.decomposition.cluster = 0;
}

/// The contact zone of a coarser mesh leaves active sets little to find; nothing where there is none. Before
/// the run is set up, and without its factors: there is memory for one set of them. What goes wrong there
/// does not end the run, and its result tells of it. Collective.
std::optional<SceneRun> solveOnCoarserMesh(SceneRun& run, const Teuchos::ParameterList& solverParameters,
                                           const RCP<const Comm>& comm, const RunOptions& options) {
  const double began = Teuchos::Time::wallTime();
  try {
    std::optional<CoarserScene> coarser = coarserScene(run.scene, run.decomposition->bodies, *comm);
    if (!coarser)
      return std::nullopt;
    joinClusters(*coarser, comm->getSize());
    Silent silent(options.companion);
    SceneRun coarse = solveScene(
        coarser->scene, solverParameters, comm,
        {.facts = {.purpose = fetidp::Purpose::start, .coarserFrom = 4 * options.facts.coarserFrom},
         .companion = &silent,
         .bodies = &coarser->bodies});
    run.result.start = {"",
                        coarser->means,
                        coarse.decomposition->problem.primalDimension,
                        coarse.solver->report().counts.hessianMultiplications,
                        coarse.solution.energy,
                        maxOverRanks(*comm, Teuchos::Time::wallTime() - began)};
    coarse.solver.reset();
    return coarse;
  } catch (const Error& error) { // on all ranks
    CoarserStart& start = run.result.start.emplace();
    start.failure = error.what();
    start.seconds = maxOverRanks(*comm, Teuchos::Time::wallTime() - began);
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
  return std::pow(nodes, -1.0 / fem::dimensionOf(bodies.front().physics));
}

/// Of each contact: the most by which a closed node has changed its gap. Collective.
std::vector<double> closingOf(const SceneRun& run) {
  std::vector<double> closing;
  const Comm& comm = *run.decomposition->problem.comm;
  for (std::size_t c = 0; c < run.decomposition->contacts.size(); ++c) {
    const contact::ContactLayout& layout = run.decomposition->contacts[c];
    const ContactState& state = run.evaluation.contacts[c];
    const std::vector<std::size_t> own = layout.ownRows();
    const std::size_t first = evenShare(own.size(), comm).first;
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
  balance.estimate = [&](std::span<const Eigen::VectorXd> u) {
    looked = (*estimator)(u);
    return looked->toBalance();
  };
  const double guess = std::min(guessedError(run), 0.1);
  // Without any coupling the energy is some times the solution's.
  balance.firstLook = 0.2 * run.solver->plan().algebraicFraction * guess;
  if (options.coarser != nullptr && options.coarser->error) // of linear elements it is halved at best
    balance.expected = 0.5 * options.coarser->error->discretisation;
  else if (run.result.start && run.result.start->failure.empty())
    balance.expected = guess * std::sqrt(2 * std::abs(run.result.start->energy));
  return balance;
}

/// What the solve and its certificate have come to.
void enterSolution(SceneRun& run) {
  RunResult& result = run.result;
  const fetidp::ContactSolution& solution = run.solution;
  result.title = run.scene.title;
  result.solve = run.solver->facts();
  result.relativeProjectedGradient = solution.relativeProjectedGradient;
  result.feasibility = solution.feasibility;
  result.complementarity = solution.complementarity;
  result.equilibrium = solution.equilibrium;
  result.algebraicError = solution.algebraicError;
  result.energy = solution.energy;
  result.activeContactNodes = solution.activeContactNodes;
  result.contactForce = solution.contactForce;
  result.loadWork = solution.loadWork;
  result.feedback.reset();
  if (run.decomposition->data.hasCoulombFriction() && std::isfinite(solution.frictionFeedback))
    result.feedback = {solution.frictionFeedback, solution.feedbackMultiplications};
  result.reason = result.solve.statusReason;
  result.status = result.solve.status == qp::Status::converged     ? RunStatus::converged
                  : result.solve.status == qp::Status::interrupted ? RunStatus::interrupted
                                                                   : RunStatus::notConverged;
}

/// A sentence where what is asked for is less than the rounding of displacements; empty if it is not.
std::string roundedGradient(const SceneRun& run) {
  const double found = run.solution.relativeProjectedGradient, asked = run.solver->plan().tolerance;
  return run.solver->plan().isBalanced || run.result.status != RunStatus::converged || found <= 2 * asked
             ? ""
             : "displacements are so large beside what deforms that their rounding leaves a projected "
               "gradient "
               "of " +
                   text(found, 2) + ": forces are not more exact than that";
}

/// What follows from the solution. Collective.
void evaluateRun(SceneRun& run) {
  const double began = Teuchos::Time::wallTime();
  const SolvedScene solved = run.solved();
  run.evaluation = evaluate(solved, run.error ? &*run.error : nullptr);
  enterSolution(run);
  RunResult& result = run.result;
  result.contacts = contactResults(solved, run.evaluation);
  result.ties = tieResults(solved);
  result.supports = supportResults(solved);
  result.preloads = preloadResults(solved);
  result.bodies = bodyResults(solved, run.evaluation);
  result.choosesClusters =
      std::any_of(run.scene.bodies.begin(), run.scene.bodies.end(),
                  [](const scene::Body& body) { return body.decomposition.cluster < 0; });
  if (run.error)
    result.error = {run.error->energyNorm, run.error->discretisation, run.solution.algebraicError, 1};
  result.times.recovery =
      run.solver->times().recovery + maxOverRanks(solved.comm(), Teuchos::Time::wallTime() - began);
  std::string unseen;
  result.missedContacts = overlapsBeyondDistance(solved, unseen);
  requireAllContacts(result);
  result.doubts = accuracy::doubts(run.scene, *run.decomposition, closingOf(run));
  result.holds = holdResults(solved);
  for (const std::string& doubt : {largeDeformations(result, Deformation::doubtful), frictionDoubts(result),
                                   unseen, roundedGradient(run), loadedHolds(result)})
    if (!doubt.empty())
      result.doubts += (result.doubts.empty() ? "" : ". ") + doubt;
}

/// Where the iteration starts: a checkpoint's λ, or the solution on a coarser mesh. Makes the solver and sets
/// it up. Collective.
RCP<const Vector> prepareSolve(SceneRun& run, const Teuchos::ParameterList& solverParameters,
                               const RCP<const Comm>& comm, const RunOptions& options) {
  const decomposition::DecomposedProblem& problem = run.decomposition->problem;
  RCP<const Vector> start;
  if (options.companion != nullptr)
    start = options.companion->begin(problem);
  fetidp::RunFacts facts = options.facts;
  facts.isUniform =
      std::ranges::all_of(run.scene.bodies, [](const scene::Body& body) { return isUniform(body); });
  facts.hasStart = !start.is_null() || options.coarser != nullptr;
  std::optional<SceneRun> coarse;
  if (ContactSolver(solverParameters, facts).planFor(problem).beginsOnCoarserMesh) {
    coarse = solveOnCoarserMesh(run, solverParameters, comm, options);
    facts.hasStart = coarse.has_value();
  }
  run.solver = std::make_unique<ContactSolver>(solverParameters, facts);
  run.solver->setup(problem, run.decomposition->data);
  if (options.companion != nullptr)
    options.companion->beforeIteration();
  const double began = Teuchos::Time::wallTime();
  if (const SceneRun* const coarser = coarse ? &*coarse : options.coarser;
      coarser != nullptr && start.is_null())
    start = startFrom(*coarser, run);
  if (run.result.start)
    run.result.start->seconds += maxOverRanks(*comm, Teuchos::Time::wallTime() - began);
  return start;
}

/// From a start to what follows from the solution. Collective.
void solveFrom(const Vector* start, const std::optional<QuantityOfScene>& quantity,
               accuracy::EnergyBounds* bounds, const RunOptions& options, SceneRun& run) {
  const bool estimatesError = options.estimatesError || quantity;
  std::optional<accuracy::ErrorEstimator> estimator;
  if (estimatesError || run.solver->plan().isBalanced)
    estimator.emplace(run.scene, *run.decomposition);
  const fetidp::ErrorBalance balance = balanceOf(run, estimator, run.error, options);
  run.solution = run.solver->solve(run.decomposition->data, start, options.companion,
                                   run.solver->plan().isBalanced ? &balance : nullptr);
  const double began = Teuchos::Time::wallTime();
  if (!estimatesError)
    run.error.reset(); // the iteration's last look, if it took one
  else if (!run.solution.isEstimated)
    run.error = (*estimator)(run.solution.displacement);
  if (quantity)
    run.result.quantity = (*quantity)(*run.solver, run.solved(), *estimator, *run.error);
  if (estimatesError)
    run.result.times.errorEstimate =
        maxOverRanks(*run.decomposition->problem.comm, Teuchos::Time::wallTime() - began);
  if (bounds != nullptr) {
    const double since = Teuchos::Time::wallTime();
    run.result.bound = guaranteedBound(*bounds, *run.solver, run.solved());
    run.result.times.bound =
        maxOverRanks(*run.decomposition->problem.comm, Teuchos::Time::wallTime() - since);
  }
  evaluateRun(run);
  if (options.requiresSmall)
    requireSmall(run.result);
}

} // namespace

SceneRun solveScene(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                    const RCP<const Comm>& comm, const RunOptions& options) {
  SceneRun run;
  const double began = Teuchos::Time::wallTime();
  run.scene = scene;
  const bool needsWhole =
      !options.quantity.point.empty() || options.bound ||
      std::any_of(scene.contacts.begin(), scene.contacts.end(), [](const auto& c) { return c.coversBody(); });
  const model::Meshes meshes = needsWhole ? model::Meshes::whole : options.meshes;
  run.decomposition = std::make_unique<model::Decomposition>(
      options.bodies == nullptr ? model::decompose(scene, comm, meshes)
                                : model::decompose(scene, std::move(*options.bodies), comm));
  if (scene.holdsFreeMotions)
    holdFreeMotions(run.scene, run.decomposition);
  if (options.changeData)
    options.changeData(*run.decomposition);
  std::optional<QuantityOfScene> quantity;
  if (options.quantity.kind != QuantityParameters::Kind::none)
    quantity.emplace(options.quantity, run.scene, *run.decomposition);
  std::optional<accuracy::EnergyBounds> bounds;
  if (options.bound)
    bounds.emplace(run.scene, *run.decomposition);
  run.result.times.assembly = maxOverRanks(*comm, Teuchos::Time::wallTime() - began);
  try {
    const RCP<const Vector> start = prepareSolve(run, solverParameters, comm, options);
    solveFrom(start.get(), quantity, bounds ? &*bounds : nullptr, options, run);
  } catch (const fetidp::ContradictionError& error) { // on all ranks
    throw inWordsOf(*run.decomposition, error);
  }
  return run;
}

void solveAgain(SceneRun& run, const RunOptions& options) {
  const RCP<const Vector> start = run.solution.multiplier;
  try {
    solveFrom(start.get(), std::nullopt, nullptr, options, run);
  } catch (const fetidp::ContradictionError& error) { // on all ranks
    throw inWordsOf(*run.decomposition, error);
  }
}

} // namespace epafi::simulation
