#pragma once

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

/// min ½uᵀAu − bᵀu, u ≥ l as a problem of ROL, Trilinos' library of optimization methods. In a file of its
/// own: ROL's headers take long to compile.
struct RolProblem {
  epafi::RCP<const epafi::Operator> a;              ///< A, symmetric positive definite
  epafi::RCP<const epafi::Vector> b;                ///< b
  epafi::RCP<epafi::Vector> lower;                  ///< l; only read
  epafi::RCP<const epafi::Operator> preconditioner; ///< M ≈ A⁻¹, applied to the free entries; may be null
};

/// Minimises from the start `u`, which becomes the last iterate, by the method that ROL's list `parameters`
/// names (list "Step"); what ROL says stands in its manual. Returns the iterations that ROL made. Collective.
int solveByRol(const RolProblem& problem, Teuchos::ParameterList parameters,
               const epafi::RCP<epafi::Vector>& u);
