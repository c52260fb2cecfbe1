#include "epafi/simulation/SceneLevels.hpp"

#include "epafi/base/PeakMemory.hpp"

#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/accuracy/RefinableMeshes.hpp"
#include "epafi/accuracy/Refinement.hpp"
#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::simulation {
namespace {

using accuracy::MeshResult;
using accuracy::RefinementGoal;
using accuracy::WantedSizes;

/// η² of all elements of all bodies, or what they add to a quantity's error, on every rank. Collective.
std::vector<double> allErrors(const SceneRun& run) {
  const model::Decomposition& decomposition = *run.decomposition;
  std::vector<std::size_t> first(1, 0);
  for (const model::BodyLayout& body : decomposition.bodies)
    first.push_back(first.back() + body.mesh->numElements());
  std::vector<double> errors(first.back(), 0.0);
  const auto& shares = run.result.quantity && run.result.quantity->failure.empty()
                           ? run.result.quantity->elements
                           : run.error->elements;
  for (std::size_t s = 0; s < decomposition.problem.subdomains.size(); ++s) {
    const decomposition::Subdomain& subdomain = decomposition.problem.subdomains[s];
    const model::BodyLayout& body = decomposition.bodies[subdomain.body];
    const auto elements = body.partition->elementsOf(subdomain.number - body.firstSubdomain);
    for (std::size_t e = 0; e < elements.size(); ++e)
      errors[first[subdomain.body] + elements[e]] = shares[s][e];
  }
  sumOverRanks(*decomposition.problem.comm, std::span(errors)); // each element is one rank's
  return errors;
}

/// In the energy norm, on the mesh of the finer one. Collective.
double distance(const SceneRun& finer, const SceneRun& coarser) {
  return accuracy::errorAgainst(finer.scene, *finer.decomposition, finer.solution.displacement,
                                *coarser.decomposition, coarser.solution.displacement)
      .energy;
}

/// Elements halved everywhere, and as many times more subdomains.
class EvenLevels final : public SceneLevels {
public:
  EvenLevels(scene::Scene scene, const Teuchos::ParameterList& solverParameters,
             const QuantityParameters& quantity, const RCP<const Comm>& comm, RunCompanion* companion)
      : SceneLevels(solverParameters, quantity, comm, companion), scene_(std::move(scene)) {}

  [[nodiscard]] int dimension() const override { return dimensionOf(scene_.bodies.front().physics); }
  [[nodiscard]] WantedSizes plan(const MeshResult& /*result*/, const RefinementGoal& goal) const override {
    return {{}, std::exp2(goal.dimension)};
  }
  std::vector<LocalOrdinal> refine(const WantedSizes& /*wanted*/) override {
    scene_ = accuracy::refined(std::move(scene_));
    return {};
  }

protected:
  scene::Scene prepare(int /*order*/, std::vector<model::BodyLayout>& /*bodies*/) override { return scene_; }
  accuracy::ElementErrors elementsOf(const SceneRun& /*run*/) override { return {}; }
  [[nodiscard]] bool measuresChange() const override { return false; }

private:
  scene::Scene scene_;
};

/// Elements as small as their errors ask for.
class LocalLevels final : public SceneLevels {
public:
  LocalLevels(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
              const QuantityParameters& quantity, const RCP<const Comm>& comm, RunCompanion* companion)
      : SceneLevels(solverParameters, quantity, comm, companion), meshes_(scene, *comm),
        dimension_(dimensionOf(scene.bodies.front().physics)) {}

  [[nodiscard]] int dimension() const override { return dimension_; }
  /// As on the gallery's scenes before meshes measure it.
  [[nodiscard]] double effectivity(int order) const override { return order == 1 ? 0.9 : 1.0; }
  [[nodiscard]] WantedSizes plan(const MeshResult& result, const RefinementGoal& goal) const override {
    RefinementGoal own(goal);
    if (meshes_.areRemeshed()) // what Gmsh does not do as asked is lost in the error's fall then
      own.leastGrowth = dimension_ == 2 ? 1.5 : 2.5;
    return wantedSizes(result.elements.squared, result.elements.orders, own,
                       [&](const std::vector<double>& halvings) {
                         std::vector<double> parts;
                         for (const std::vector<double>& body : meshes_.parts(ofBodies(halvings)))
                           parts.insert(parts.end(), body.begin(), body.end());
                         return parts;
                       });
  }
  std::vector<LocalOrdinal> refine(const WantedSizes& wanted) override {
    const std::vector<std::vector<double>> halvings = ofBodies(wanted.halvings);
    if (companion() != nullptr && meshes_.areRemeshed())
      companion()->meshing();
    std::vector<LocalOrdinal> ancestors;
    LocalOrdinal first = 0;
    const auto ofBodies = meshes_.refine(halvings, comm());
    for (std::size_t b = 0; b < ofBodies.size(); ++b) {
      for (const LocalOrdinal ancestor : ofBodies[b])
        ancestors.push_back(first + ancestor);
      first += static_cast<LocalOrdinal>(halvings[b].size());
    }
    return ancestors;
  }

protected:
  [[nodiscard]] std::vector<std::vector<double>> ofBodies(const std::vector<double>& elements) const {
    std::vector<std::vector<double>> values;
    auto next = elements.begin();
    for (const model::BodyLayout& body : run().decomposition->bodies) {
      const auto end = next + body.mesh->numElements();
      values.emplace_back(next, end);
      next = end;
    }
    return values;
  }
  scene::Scene prepare(int order, std::vector<model::BodyLayout>& bodies) override {
    scene::Scene scene = meshes_.scene(order);
    bodies = meshes_.layout(scene, comm());
    return scene;
  }
  [[nodiscard]] bool measuresChange() const override { return true; }
  accuracy::ElementErrors elementsOf(const SceneRun& run) override {
    accuracy::ElementErrors elements{allErrors(run), {}, {}};
    for (const std::vector<double>& own : meshes_.measures())
      elements.measures.insert(elements.measures.end(), own.begin(), own.end());
    return elements;
  }

private:
  accuracy::RefinableMeshes meshes_;
  int dimension_;
};

} // namespace

SceneLevels::SceneLevels(const Teuchos::ParameterList& solverParameters, QuantityParameters quantity,
                         RCP<const Comm> comm, RunCompanion* companion)
    : solverParameters_(solverParameters), quantity_(std::move(quantity)), comm_(std::move(comm)),
      companion_(companion), start_(Teuchos::Time::wallTime()), bytesBefore_(resetPeakBytes()) {}

MeshResult SceneLevels::solve(int order) {
  std::vector<model::BodyLayout> bodies;
  const scene::Scene scene = prepare(order, bodies);
  using fetidp::Purpose;
  const bool isOfNumber = quantity_.kind != QuantityParameters::Kind::none;
  RunOptions options{.estimatesError = true,
                     .bound = isBounded_,
                     .quantity = quantity_,
                     .facts = {.purpose = isOfNumber ? Purpose::quantity : Purpose::mesh},
                     .companion = companion_};
  if (!bodies.empty())
    options.bodies = &bodies;
  if (hasRun_)
    options.coarser = &run_;
  SceneRun run = solveScene(scene, solverParameters_, comm_, options);
  if (hasRun_ && run.solver->report().status == qp::Status::interrupted)
    throw Interrupted("stopped in the iteration"); // its iterate may be worse than the last mesh's solution
  const double change = hasRun_ && measuresChange() ? distance(run, run_) : 0;
  run_ = std::move(run); // the coarser one is needed no longer
  hasRun_ = true;
  MeshResult result = resultOf(run_);
  result.change = change;
  result.seconds = maxOverRanks(*comm_, Teuchos::Time::wallTime() - start_);
  start_ = Teuchos::Time::wallTime();
  return result;
}

MeshResult SceneLevels::resultOf(const SceneRun& run) {
  MeshResult result;
  result.order = 1;
  for (const model::BodyLayout& body : run.decomposition->bodies)
    result.order = std::max(result.order, mesh::orderOf(body.mesh->cellType()));
  result.unknowns = run.decomposition->problem.primalDimension;
  result.multiplications = run.solver->report().counts.hessianMultiplications;
  result.energyNorm = run.error->energyNorm;
  result.discretisation = run.error->discretisation;
  result.algebraic = run.solution.algebraicError;
  if (run.result.quantity && run.result.quantity->failure.empty())
    result.quantity = {run.result.quantity->value, run.result.quantity->bar, run.result.quantity->algebraic,
                       run.result.quantity->width};
  result.bytes = sumOverRanks(*comm_, peakBytes() - bytesBefore_);
  // Short of its tolerance an iteration may still be good enough for a mesh: its error is known, and counts.
  const qp::SolveReport& report = run.solver->report();
  if (report.status == qp::Status::interrupted ||
      (report.status != qp::Status::converged && !(result.algebraic <= run.error->toBalance())))
    result.failure = "the iteration did not reach its tolerance on a mesh: " + report.reason;
  else if (run.result.quantity && !run.result.quantity->failure.empty())
    result.failure = "what is asked for has no error bar: " + run.result.quantity->failure;
  result.elements = elementsOf(run);
  return result;
}

std::unique_ptr<SceneLevels> levelsOf(const scene::Scene& scene,
                                      const Teuchos::ParameterList& solverParameters,
                                      const AccuracyParameters& accuracy, const RCP<const Comm>& comm,
                                      RunCompanion* companion) {
  if (accuracy.refinement == AccuracyParameters::Refinement::local)
    return std::make_unique<LocalLevels>(scene, solverParameters, accuracy.quantity, comm, companion);
  return std::make_unique<EvenLevels>(scene, solverParameters, accuracy.quantity, comm, companion);
}

} // namespace epafi::simulation
