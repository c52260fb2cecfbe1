#pragma once

/// −Δu = 1 on the unit square, u = 0 on all its sides: what linear solvers are commonly measured by.

#include "epafi/linear/UnassembledOperator.hpp"
#include "epafi/model/Decompose.hpp"

#include <Eigen/Core>

#include <memory>

namespace epafi::drivers {

/// Q1 elements, 1/h = n; the (n − 1)² inner nodes are the unknowns, numbered row by row.
struct PoissonProblem {
  /// \param elements    n ≥ 2
  /// \param subdomains  1/H ≤ n: squares of (n/m)² elements; each rank has a run of them, strips from the
  /// bottom up
  /// Collective.
  PoissonProblem(int elements, int subdomains, const RCP<const Comm>& comm);

  std::shared_ptr<const model::Decomposition> decomposition;
  RCP<const linear::UnassembledOperator> k;
};

/// The exact solution of the discrete problem at all inner nodes, (n − 1) × (n − 1), by separation of
/// variables: with the stiffness A and the mass M of linear elements in one dimension K = A ⊗ M + M ⊗ A, and
/// both have the eigenvectors sin(iπkh). Two dense products, no factorisation. Not collective.
Eigen::MatrixXd solutionBySines(int elements);

/// ‖u − u_exact‖ / ‖u_exact‖ of a vector on the problem's map. Collective.
double relativeError(const Vector& u, const Eigen::MatrixXd& exact);

} // namespace epafi::drivers
