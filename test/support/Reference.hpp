#pragma once

/// Solutions by FETI-DP and by a dense solver that knows no subdomains, in the same terms.

#include "DenseProblem.hpp"

#include "epafi/ContactSolver.hpp"

namespace epafi::fetidp {

/// u at all nodes of each body.
using Field = std::vector<Eigen::VectorXd>;

/// Parameters with the given tolerances; else the defaults.
Teuchos::ParameterList toleranceOf(double tolerance);

/// A scene, solved.
struct Solved {
  explicit Solved(const scene::Scene& scene, double tolerance = 1e-11);

  model::Decomposition decomposition;
  ContactSolver solver;
  ContactSolution solution;
};

/// u at the nodes, all copies of a node averaged. Collective.
Field fieldOf(const model::Decomposition& decomposition, const ContactSolution& solution);
/// Largest difference of the copies of a node. Collective.
double largestJump(const model::Decomposition& decomposition, const ContactSolution& solution);

/// max |a − b| over all bodies, relative to max |b|.
double fieldError(const Field& a, const Field& b);

/// min ½uᵀKu − fᵀu, B_I u ≤ c over the nodes of the bodies, by a primal-dual active set method on dense
/// matrices.
struct PrimalSolution {
  Field field;
  Eigen::VectorXd force; ///< λ_I
  double energy = 0;
  double violation = 0; ///< of the optimality conditions, relative: the solution vouches for itself
};

/// Collective.
PrimalSolution solveUndecomposed(const model::Decomposition& decomposition);

} // namespace epafi::fetidp
