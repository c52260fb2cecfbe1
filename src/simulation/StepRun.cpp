#include "epafi/simulation/StepRun.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <string>
#include <utility>

namespace epafi::simulation {
namespace {

std::string inStep(const std::string& name) {
  return " (in step \"" + name + "\")";
}

/// What came of a step; where it has not been solved the run's reason names it from now on.
StepResult resultOf(const std::string& name, RunResult& result) {
  if (result.status != RunStatus::converged)
    result.reason += inStep(name);
  double dissipation = 0;
  for (const ContactResult& contact : result.contacts)
    if (contact.friction)
      dissipation += contact.friction->dissipation;
  return {name,
          result.solve.counts.hessianMultiplications,
          result.energy + result.loadWork,
          result.loadWork,
          dissipation,
          result.contacts,
          result.supports,
          result.status,
          result.reason};
}

/// Does what a step needs; whether it has a solution is said with its name.
template <class Action>
auto forStep(const scene::Step& step, const Action& action) {
  try {
    return action();
  } catch (const SolvabilityError& error) {
    throw SolvabilityError(error.kind(), std::string(error.what()) + inStep(step.name));
  }
}

/// c of rows of friction: what they have slipped at the end of a step, from where the scene begins.
class Slip {
public:
  explicit Slip(const decomposition::DecomposedProblem& problem) {
    std::vector<GlobalOrdinal> rows;
    for (const GlobalOrdinal row : localIndices(*problem.multiplierMap))
      if (problem.kindOf(decomposition::MultiplierNumber(row)) == decomposition::RowKind::friction)
        rows.push_back(row);
    slip_ = rcp(new Vector(makeMap(std::move(rows), problem.comm)));
  }
  /// Takes in a step's: slack = c − Bu.
  void add(const Vector& slack) {
    const auto values = slip_->getDataNonConst();
    const auto left = slack.getData();
    for (LocalOrdinal i = 0; i < values.size(); ++i)
      values[i] -= left[slack.getMap()->getLocalElement(slip_->getMap()->getGlobalElement(i))];
  }
  /// Where the next step begins.
  void enter(decomposition::ProblemData& data) const { data.setGaps(*slip_); }

private:
  RCP<Vector> slip_;
};

} // namespace

SceneRun solveSteps(const scene::Scene& scene, const std::vector<scene::Step>& steps,
                    const Teuchos::ParameterList& solverParameters, const RCP<const Comm>& comm,
                    const RunOptions& options, const std::function<void(SceneRun&)>& tell) {
  RunOptions first = options;
  first.facts.coarserFrom = fetidp::RunFacts().coarserFrom; // a coarser mesh would know one step alone
  SceneRun run = forStep(
      steps[0], [&] { return solveScene(scene::atStep(scene, steps, 0), solverParameters, comm, first); });
  model::Decomposition& cut = *run.decomposition;
  std::vector<StepResult>& results = run.result.steps;
  results.push_back(resultOf(steps[0].name, run.result));
  Slip slip(cut.problem);
  for (std::size_t k = 1; k < steps.size() && results.back().status == RunStatus::converged; ++k) {
    run.result.status = RunStatus::running;
    run.result.reason =
        "the run went on with the next load step; if it is not under way any more it ended there";
    if (tell)
      tell(run);
    slip.add(*run.solution.slack);
    run.scene = scene::atStep(scene, steps, k);
    forStep(steps[k], [&] {
      model::Decomposition next = model::decompose(run.scene, std::move(cut.bodies), comm); // its data alone
      cut.bodies = std::move(next.bodies);
      cut.contacts = std::move(next.contacts);
      cut.ties = std::move(next.ties);
      cut.equations = std::move(next.equations);
      cut.data = std::move(next.data);
      slip.enter(cut.data);
      solveAgain(run, options);
    });
    results.push_back(resultOf(steps[k].name, run.result));
  }
  return run;
}

} // namespace epafi::simulation
