#pragma once

/// The same discrete problem without any decomposition, solved another way: one matrix a body, sparse LU of
/// the saddle point system, and a primal–dual active set method (Hintermüller, Ito, Kunisch, *SIAM J. Optim.*
/// 13 (2003)).

#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::test {

struct UndecomposedSolution {
  std::vector<Eigen::VectorXd> deflection; ///< of each body at its nodes
  double energy = 0;
  double contactForce = 0;
  int activeContactNodes = 0; ///< of the active set
};

/// Each rank computes it alone. \throws std::runtime_error if the active set does not settle.
UndecomposedSolution solveUndecomposed(const scene::Scene& scene);

} // namespace epafi::test
