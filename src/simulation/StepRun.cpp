#include "epafi/simulation/StepRun.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/contact/ContactMatrix.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

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
          result.preloads,
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

/// What friction has slipped at the end of a step, from where the scene begins, as vectors in space: c of its
/// rows, which may be other ones in the next step.
class Slip {
public:
  /// Takes in a step's: slack = c − Bu. Not collective.
  void add(const model::Decomposition& cut, const Vector& slack) {
    const auto left = slack.getData();
    forEachRow(cut, [&](const ContactLayout& contact, GlobalOrdinal place, const Eigen::Vector3d& tangent,
                        LocalOrdinal row) {
      slip_.try_emplace(keyOf(contact, place), Eigen::Vector3d::Zero()).first->second -= left[row] * tangent;
    });
  }
  /// Where the next step begins. Collective. \throws InputError if the rows are those of other nodes
  void enter(model::Decomposition& cut) const {
    std::map<GlobalOrdinal, double> gaps;
    collectively(*cut.problem.comm, [&] {
      forEachRow(cut, [&](const ContactLayout& contact, GlobalOrdinal place, const Eigen::Vector3d& tangent,
                          LocalOrdinal row) {
        const auto known = slip_.find(keyOf(contact, place));
        if (known == slip_.end())
          throw InputError("contact " + inQuotes(contact.name) +
                           " has its multipliers on other nodes than in the step before, so that what has "
                           "slipped is not known; say by Multipliers whose they are");
        gaps[cut.problem.multiplierMap->getGlobalElement(row)] = known->second.dot(tangent);
      });
    });
    std::vector<GlobalOrdinal> rows;
    std::vector<double> values;
    for (const auto& [row, gap] : gaps) {
      rows.push_back(row);
      values.push_back(gap);
    }
    cut.data.setGaps(Vector(mapInOrder(rows, cut.problem.comm), Teuchos::arrayViewFromVector(values)));
  }

private:
  using ContactLayout = contact::ContactLayout;

  using Key = std::array<GlobalOrdinal, 3>; ///< contact of the scene, body, node

  static Key keyOf(const ContactLayout& contact, GlobalOrdinal place) {
    return {contact.number, contact.firstBody, contact.firstNodes[place]};
  }
  /// action(contact, place, tangent, row) for this rank's rows of friction.
  template <class Action>
  static void forEachRow(const model::Decomposition& cut, const Action& action) {
    const GlobalOrdinal numTangents = cut.problem.components - 1;
    for (const ContactLayout& contact : cut.contacts) {
      if (contact.firstFriction < 0)
        continue;
      const contact::ContactTangents tangents(contact);
      for (GlobalOrdinal place = 0; place < contact.numRows(); ++place)
        for (GlobalOrdinal k = 0; k < numTangents; ++k)
          if (const LocalOrdinal row = cut.problem.multiplierMap->getLocalElement(
                  cut.problem.numInequalities + numTangents * (contact.firstFriction + place) + k);
              row >= 0)
            action(contact, place, tangents.at(place)[k], row);
    }
  }

  std::map<Key, Eigen::Vector3d> slip_; ///< of this rank's rows
};

/// Enters into a scene what the solution of the step before says of it.
void take(const SceneRun& before, scene::Scene& scene) {
  for (const PreloadResult& preload : before.result.preloads)
    for (scene::SurfaceContact& contact : scene.contacts)
      if (contact.name == preload.name && contact.preload->kind == scene::Preload::Kind::locked)
        contact.preload->value = preload.shortening;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    for (fem::SolidSupport& support : scene.bodies[b].supports)
      if (support.displacements) {
        const fem::SolidBody body(scene.bodies[b], *before.decomposition->bodies[b].mesh);
        const std::vector<GlobalOrdinal> nodes = body.nodesOf(support.name, support.surface);
        const std::vector<Eigen::Vector3d> u = displacementsAt(before.solved(), static_cast<int>(b), nodes);
        for (std::size_t k = 0; k < nodes.size(); ++k)
          (*support.displacements)[nodes[k]] = {u[k][0], u[k][1], u[k][2]};
      }
}

/// What is held, may touch and is joined: the same words where rows are the same.
std::vector<std::string> rowsOf(const scene::Scene& scene) {
  std::vector<std::string> rows;
  for (const scene::Body& body : scene.bodies)
    for (const fem::SolidSupport& support : body.supports)
      rows.push_back(body.name + '/' + support.name);
  for (const scene::SurfaceContact& contact : scene.contacts)
    if (contact.isOn)
      rows.push_back(contact.name + (contact.preload && !contact.preload->holdsLength() ? ", pulled" : ""));
  return rows;
}

/// What another step changes in the data of the problem. Collective.
void changeData(SceneRun& run, const RCP<const Comm>& comm) {
  model::Decomposition& cut = *run.decomposition;
  model::Decomposition next = model::decompose(run.scene, std::move(cut.bodies), comm);
  cut.bodies = std::move(next.bodies);
  cut.contacts = std::move(next.contacts);
  cut.ties = std::move(next.ties);
  cut.equations = std::move(next.equations);
  cut.sections = std::move(next.sections);
  cut.data = std::move(next.data);
}

} // namespace

SceneRun solveSteps(const scene::Scene& scene, const std::vector<scene::Step>& steps,
                    const Teuchos::ParameterList& solverParameters, const RCP<const Comm>& comm,
                    const RunOptions& options, const std::function<void(SceneRun&)>& tell) {
  RunOptions first = options;
  first.facts.coarserFrom = fetidp::RunFacts().coarserFrom; // a coarser mesh would know one step alone
  SceneRun run = forStep(
      steps[0], [&] { return solveScene(scene::atStep(scene, steps, 0), solverParameters, comm, first); });
  std::vector<StepResult> results{resultOf(steps[0].name, run.result)};
  Slip slip;
  for (std::size_t k = 1; k < steps.size() && results.back().status == RunStatus::converged; ++k) {
    run.result.status = RunStatus::running;
    run.result.reason =
        "the run went on with the next load step; if it is not under way any more it ended there";
    run.result.steps = results;
    if (tell)
      tell(run);
    slip.add(*run.decomposition, *run.solution.slack);
    scene::Scene next = scene::atStep(scene, steps, k);
    take(run, next);
    forStep(steps[k], [&] {
      if (rowsOf(run.scene) == rowsOf(next)) {
        run.scene = std::move(next);
        changeData(run, comm);
        slip.enter(*run.decomposition);
        solveAgain(run, options);
        return;
      }
      std::vector<model::BodyLayout> bodies = std::move(run.decomposition->bodies);
      first.bodies = &bodies;
      first.changeData = [&](model::Decomposition& cut) { slip.enter(cut); };
      run.solver.reset(); // before there is another one
      run = solveScene(next, solverParameters, comm, first);
    });
    results.push_back(resultOf(steps[k].name, run.result));
  }
  run.result.steps = std::move(results);
  return run;
}

} // namespace epafi::simulation
