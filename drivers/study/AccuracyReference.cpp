#include "AccuracyReference.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::drivers {

ContactResult contactOf(const simulation::SceneRun& run) {
  ContactResult sum;
  for (const simulation::ContactResult& contact : run.result.contacts) {
    sum.area += contact.area;
    sum.force += contact.force;
  }
  return sum;
}

double referenceError(double distance2, double distance4) {
  const double ratio = distance2 > 0 ? std::max(3.0, std::pow(distance4 / distance2, 2)) : 3.0;
  return distance2 / std::sqrt(ratio - 2);
}

simulation::SceneRun solveTightly(const scene::Scene& scene, const simulation::SceneRun* coarser,
                                  const RCP<const Comm>& comm) {
  Teuchos::ParameterList parameters;
  parameters.set("Tolerance", 1e-10).set("Equilibrium Tolerance", 1e-10);
  simulation::SceneRun run =
      simulation::solveScene(scene, parameters, comm, {.estimatesError = true, .coarser = coarser});
  if (run.solver->report().status != qp::Status::converged)
    throw Error("the reference solution of \"" + scene.title +
                "\" was not reached: " + run.solver->report().reason);
  run.solver.reset();
  return run;
}

AccuracyReference::AccuracyReference(const AccuracyProblem& problem, const RCP<const Comm>& comm) {
  const simulation::SceneRun* last = nullptr;
  tight_.reserve(problem.meshes); // `last` stays where it is
  for (int level = 0; level < problem.meshes; ++level) {
    tight_.push_back({solveTightly(problem.onMesh(level), last, comm), {}, {}});
    tight_.back().contact = contactOf(tight_.back().run);
    last = &tight_.back().run;
  }
  if (problem.exact) {
    const TightSolution& finest = tight_.back();
    for (TightSolution& tight : tight_)
      tight.error = accuracy::errorNorms(tight.run.scene, *tight.run.decomposition,
                                         tight.run.solution.displacement, problem.exact);
    // Galerkin: ‖u‖² = ‖u_h‖² + ‖u − u_h‖²; of the L2 norm u_h's own is near enough for a denominator.
    norms_ = accuracy::errorNorms(finest.run.scene, *finest.run.decomposition,
                                  finest.run.solution.displacement, {});
    norms_.energy = std::hypot(norms_.energy, finest.error.energy);
    contact_ = finest.contact; // exact at the nodes
    return;
  }
  const simulation::SceneRun between = solveTightly(problem.onMesh(problem.meshes), last, comm);
  const simulation::SceneRun reference = solveTightly(problem.onMesh(problem.meshes + 1), &between, comm);
  const double distance2 =
      accuracy::errorAgainst(reference.scene, *reference.decomposition, reference.solution.displacement,
                             *between.decomposition, between.solution.displacement)
          .energy;
  for (TightSolution& tight : tight_)
    tight.error =
        accuracy::errorAgainst(reference.scene, *reference.decomposition, reference.solution.displacement,
                               *tight.run.decomposition, tight.run.solution.displacement);
  ownError_ = referenceError(distance2, tight_.back().error.energy);
  for (TightSolution& tight : tight_)
    tight.error.energy = std::hypot(tight.error.energy, ownError_);
  norms_ =
      accuracy::errorNorms(reference.scene, *reference.decomposition, reference.solution.displacement, {});
  norms_.energy = std::hypot(norms_.energy, ownError_);
  contact_ = contactOf(reference);
}

} // namespace epafi::drivers
