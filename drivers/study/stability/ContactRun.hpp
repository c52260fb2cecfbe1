#pragma once

/// One contact problem, solved and checked against the undecomposed problem.

#include "StabilityCase.hpp"

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/scene/Scene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <functional>

namespace epafi::drivers {

struct ContactTask {
  scene::Scene scene;
  double tolerance = 1e-8;
  Teuchos::ParameterList solver =
      Teuchos::ParameterList(); ///< what differs from the defaults, tolerances aside
  /// What an application changes in the problem before it hands it over. Such problems are checked by the solver's own
  /// residuals alone, for there is no scene that they belong to.
  std::function<void(decomposition::DecomposedProblem&)> change = {};
  double contrast = 1; ///< of the stiffest to the softest material
  bool hasReference =
      true; ///< whether a direct solver is asked as well; large problems would take it minutes
};

/// Without preconditioner: the method of the paper.
Teuchos::ParameterList plainMethod();

/// What is allowed of a solution to the tolerance ε on the dual residual, ‖r‖ ≤ ε‖d̃‖. Its error in the energy norm is
/// rᵀF⁻¹r, relative to d̃ᵀF⁻¹d̃ no more than ε²κ(F); κ(F) grows with the contrast of materials and with H/h: up to 1e4 times
/// the contrast here. No less is asked for than 100 times the error of sparse LU without refinement.
struct Allowance {
  double balance = 0;         ///< 100 ε √contrast, at least 1e-8; a dual energy norm too
  double penetration = 0;     ///< 1000 ε, at least 1e-7, as ContactSolver promises
  double complementarity = 0; ///< 100 ε, at least 1e-8
  double energyNorm = 0;      ///< max(1e4 ε, 100 ε √contrast), at least 1e-8
};
Allowance allowanceOf(double tolerance, double contrast);

/// Solves within a minute of iterations. Outcome: solved, wrongAnswer, or stopped. Collective.
/// \throws InputError, SolvabilityError or Error, the same on all ranks.
CaseResult solveContact(const ContactTask& task, const RCP<const Comm>& comm);

} // namespace epafi::drivers
