#pragma once

/// What the errors of a problem are measured against, and what each mesh of its ladder can do at best.

#include "AccuracyProblem.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <vector>

namespace epafi::drivers {

/// Area (membranes: length) of the closed nodes and sum of the forces, over all contacts.
struct ContactResult {
  double area = 0, force = 0;
};
ContactResult contactOf(const simulation::SceneRun& run);

/// The solution of the discrete problem on one mesh, with an iteration that leaves no error to speak of.
struct TightSolution {
  simulation::SceneRun run;
  accuracy::ErrorNorms error; ///< of discretisation, absolute
  ContactResult contact;
};

/// The error that is left of u_h against the exact solution, from its distances to a reference solution:
/// squares of energy errors add up, ‖u_h − u‖² = ‖u_h − u_ref‖² + ‖u_ref − u‖², as they do for Galerkin's
/// method, and are C²h^{2p}. Then r = d₄²/d₂² = 4^p + 1, with d₂ and d₄ the distances of the solutions on
/// meshes of 2 and 4 times the reference's size, and ‖u_ref − u‖² = d₂²/(r − 2). Where the distances have no
/// such order (r ≤ 3), p is taken as ½.
/// \returns ‖u_ref − u‖
double referenceError(double distance2, double distance4);

class AccuracyReference {
public:
  /// Solves on all meshes of the ladder and, unless a closed form is known, on two finer ones, with tolerance
  /// 1e-10. Collective. \throws Error if an iteration does not get there.
  AccuracyReference(const AccuracyProblem& problem, const RCP<const Comm>& comm);

  /// On a mesh of the ladder.
  [[nodiscard]] const TightSolution& tight(int level) const { return tight_[level]; }
  /// Norms of the solution itself, which errors are relative to.
  [[nodiscard]] const accuracy::ErrorNorms& norms() const { return norms_; }
  [[nodiscard]] const ContactResult& contact() const { return contact_; }
  /// Of the finer mesh, in the energy norm, absolute; contained in all errors. 0 of a closed form.
  [[nodiscard]] double ownError() const { return ownError_; }

private:
  void measureAgainst(const simulation::SceneRun& reference);

  std::vector<TightSolution> tight_;
  accuracy::ErrorNorms norms_;
  ContactResult contact_;
  double ownError_ = 0;
};

/// Solves to tolerance 1e-10, from a coarser solution if there is one. The solver's factors are given up
/// again. Collective. \throws Error if it does not get there.
simulation::SceneRun solveTightly(const scene::Scene& scene, const simulation::SceneRun* coarser,
                                  const RCP<const Comm>& comm);

} // namespace epafi::drivers
