#include "epafi/simulation/StepRun.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/simulation/StepsDone.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
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
          result.ties,
          result.holds,
          result.doubts,
          result.status,
          result.reason,
          result.feedback,
          result.error ? result.error->relative() : std::numeric_limits<double>::quiet_NaN()};
}

/// Those of the last step, and of the first one that has others.
std::string doubtsOf(const std::vector<StepResult>& steps) {
  std::string doubts = steps.back().doubts;
  const auto differs = [&](const StepResult& step) {
    return !step.doubts.empty() && step.doubts != steps.back().doubts;
  };
  if (const auto first = std::ranges::find_if(steps, differs); first != steps.end()) {
    const auto others = std::count_if(first + 1, steps.end(), differs);
    doubts += (doubts.empty() ? "" : ". ") + first->doubts + inStep(first->name) +
              (others > 0 ? "; the report has those of " + std::to_string(others) + " more" : "");
  }
  return doubts;
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
  /// What an earlier run has left.
  explicit Slip(const std::vector<NodeSlip>& nodes) {
    for (const NodeSlip& node : nodes)
      slip_[{node.contact, node.body, node.node}] = Eigen::Vector3d(node.slip.data());
  }
  /// Takes in a step's: slack = c − Bu. Not collective.
  void add(const model::Decomposition& cut, const Vector& slack) {
    const auto left = slack.getData();
    forEachRow(cut, [&](const ContactLayout& contact, GlobalOrdinal place, const Eigen::Vector3d& tangent,
                        LocalOrdinal row) {
      slip_.try_emplace(keyOf(contact, place), Eigen::Vector3d::Zero()).first->second -= left[row] * tangent;
    });
  }
  /// Where the next step begins; forgets what has no rows on this rank. Collective. \throws InputError if the
  /// rows are those of other nodes
  void enter(model::Decomposition& cut) {
    std::map<GlobalOrdinal, double> gaps;
    std::map<Key, Eigen::Vector3d> own;
    collectively(*cut.problem.comm, [&] {
      forEachRow(cut, [&](const ContactLayout& contact, GlobalOrdinal place, const Eigen::Vector3d& tangent,
                          LocalOrdinal row) {
        const auto known = slip_.find(keyOf(contact, place));
        if (known == slip_.end())
          throw InputError("contact " + inQuotes(contact.name) +
                           " has its multipliers on other nodes than in the step before, so that what has "
                           "slipped is not known; say by Multipliers whose they are");
        gaps[cut.problem.multiplierMap->getGlobalElement(row)] = known->second.dot(tangent);
        own.insert(*known);
      });
    });
    slip_ = std::move(own);
    std::vector<GlobalOrdinal> rows;
    std::vector<double> values;
    for (const auto& [row, gap] : gaps) {
      rows.push_back(row);
      values.push_back(gap);
    }
    cut.data.setGaps(Vector(mapInOrder(rows, cut.problem.comm), Teuchos::arrayViewFromVector(values)));
  }
  /// StepsDone::slip. Precondition: a step was added or entered last. Collective.
  [[nodiscard]] std::vector<NodeSlip> gathered(const Comm& comm) const {
    std::vector<NodeSlip> nodes;
    for (const auto& [key, slip] : slip_)
      nodes.push_back({key[0], key[1], key[2], {slip[0], slip[1], slip[2]}});
    nodes = gatherOnFirst(comm, nodes);
    const auto placeOf = [](const NodeSlip& node) { return Key{node.contact, node.body, node.node}; };
    std::ranges::sort(nodes, {}, placeOf);
    return nodes;
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

  std::map<Key, Eigen::Vector3d> slip_; ///< of this rank's rows; before the first `enter` perhaps of others
};

/// StepsDone::meshes: a sum over nodes of their places with weights of their own. Collective.
std::vector<double> numbersOf(const model::Decomposition& cut) {
  constexpr double golden = 0.6180339887498949;
  std::vector<AccurateSum> sums(cut.bodies.size());
  for (const decomposition::Subdomain& part : cut.problem.subdomains)
    for (const GlobalOrdinal node : part.nodes) {
      const Point at = cut.bodies[part.body].mesh->point(node);
      const double weight = 1 + std::fmod(golden * static_cast<double>(node + 1), 1.0);
      sums[part.body].add(weight * (at[0] + weight * (at[1] + weight * at[2])));
    }
  std::vector<double> numbers(sums.size());
  sumOverRanks(*cut.problem.comm, sums, numbers.data());
  return numbers;
}

/// Nodes that have slipped are known by their numbers. Collective. \throws InputError if a mesh has changed
void requireSameMeshes(StepsDone& done, const model::Decomposition& cut) {
  constexpr double roundOff = 1e-9;
  const std::vector<double> numbers = numbersOf(cut);
  if (done.results.empty())
    done.meshes = numbers;
  for (std::size_t b = 0; b < numbers.size(); ++b)
    if (done.meshes.size() != numbers.size() ||
        !(std::abs(done.meshes[b] - numbers[b]) <= roundOff * std::abs(numbers[b])))
      throw InputError("body " + inQuotes(cut.bodies[b].name) +
                       " has another mesh, or is cut in another way, than in the run that solved the steps "
                       "before; name a checkpoint of this one, or start without");
}

/// The next step's scene, with what the solution of the step before says of it. \throws InputError if that is
/// not known
scene::Scene sceneAfter(const StepsDone& done, const scene::Scene& scene,
                        const std::vector<scene::Step>& steps) {
  scene::Scene next = scene::atStep(scene, steps, done.results.size());
  if (done.results.empty())
    return next;
  for (const PreloadResult& preload : done.results.back().preloads)
    for (scene::SurfaceContact& contact : next.contacts)
      if (contact.name == preload.name && contact.preload->kind == scene::Preload::Kind::locked)
        contact.preload->value = preload.shortening;
  for (scene::Body& body : next.bodies)
    for (fem::SolidSupport& support : body.supports) {
      if (!support.displacements)
        continue;
      const auto held = std::ranges::find_if(done.held, [&](const HeldSupport& other) {
        return other.body == body.name && other.name == support.name;
      });
      if (held == done.held.end())
        throw InputError("where support " + inQuotes(body.name + '/' + support.name) + " is after step " +
                         inQuotes(done.results.back().name) +
                         " is not known: the run that solved that step did not hold it in the next one");
      support.displacements = held->displacements;
    }
  return next;
}

/// The supports that a scene holds where they are. Collective.
std::vector<HeldSupport> heldBy(const scene::Scene& next, const SceneRun& before) {
  std::vector<HeldSupport> all;
  for (std::size_t b = 0; b < next.bodies.size(); ++b)
    for (const fem::SolidSupport& support : next.bodies[b].supports)
      if (support.displacements) {
        const fem::SolidBody body(next.bodies[b], *before.decomposition->bodies[b].mesh);
        const std::vector<GlobalOrdinal> nodes = body.nodesOf(support.name, support.surface);
        const std::vector<Eigen::Vector3d> u = displacementsAt(before.solved(), static_cast<int>(b), nodes);
        HeldSupport held{next.bodies[b].name, support.name, {}};
        for (std::size_t k = 0; k < nodes.size(); ++k)
          held.displacements[nodes[k]] = {u[k][0], u[k][1], u[k][2]};
        all.push_back(std::move(held));
      }
  return all;
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

bool changesRows(const scene::Scene& scene, const std::vector<scene::Step>& steps, std::size_t step) {
  return rowsOf(scene::atStep(scene, steps, step - 1)) != rowsOf(scene::atStep(scene, steps, step));
}

SceneRun solveSteps(const scene::Scene& scene, const std::vector<scene::Step>& steps,
                    const Teuchos::ParameterList& solverParameters, const RCP<const Comm>& comm,
                    const RunOptions& options, const std::function<void(SceneRun&)>& tell) {
  RunOptions first = options;
  first.facts.coarserFrom = fetidp::RunFacts().coarserFrom; // a coarser mesh would know one step alone
  first.facts.solvesAgain = steps.size() > 1;
  const StepsDone* const earlier = options.companion != nullptr ? options.companion->stepsDone() : nullptr;
  StepsDone done = earlier != nullptr ? *earlier : StepsDone();
  Slip slip(done.slip);
  SceneRun run;
  for (std::size_t k = done.results.size(); k < steps.size(); ++k) {
    scene::Scene next = sceneAfter(done, scene, steps);
    if (!done.changesRows) // others are looked for with other rows
      next.holds = run.scene.holds;
    forStep(steps[k], [&] {
      if (run.solver && !done.changesRows) {
        run.scene = std::move(next);
        changeData(run, comm);
        slip.enter(*run.decomposition);
        solveAgain(run, options);
        return;
      }
      std::vector<model::BodyLayout> bodies;
      if (run.solver) {
        bodies = std::move(run.decomposition->bodies);
        first.bodies = &bodies;
      }
      first.changeData = [&](model::Decomposition& cut) {
        requireSameMeshes(done, cut);
        if (k > 0)
          slip.enter(cut);
      };
      run.solver.reset(); // before there is another one
      run = solveScene(next, solverParameters, comm, first);
    });
    done.results.push_back(resultOf(steps[k].name, run.result));
    run.result.steps = done.results;
    if (run.result.status != RunStatus::converged)
      break;
    slip.add(*run.decomposition, *run.solution.slack);
    done.slip = slip.gathered(*comm);
    const bool isLast = k + 1 == steps.size();
    if (!isLast) {
      next = scene::atStep(scene, steps, k + 1);
      done.held = heldBy(next, run);
      done.changesRows = changesRows(scene, steps, k + 1);
    }
    if (options.companion != nullptr)
      options.companion->stepDone(done);
    if (isLast)
      break;
    run.result.status = RunStatus::running;
    run.result.reason =
        "the run went on with the next load step; if it is not under way any more it ended there";
    if (tell)
      tell(run);
  }
  if (!done.results.empty())
    run.result.doubts = doubtsOf(done.results);
  return run;
}

} // namespace epafi::simulation
