#pragma once

/// The membranes of the model problem once the contact zone is known: the least that any active set method
/// has to solve at least once, and what a linear solver is measured by.

#include "LinearSolve.hpp"

namespace epafi::drivers {

/// Which membranes: see scene::modelProblem, whose bodies, supports and loads these are.
struct MembraneChoice {
  bool coercive = true;
  int elements = 0; ///< 1/h: a multiple of 4
  int closedNodes =
      0; ///< the lowest so many nodes of x = 1 are one node of both bodies, the others two free ones
};

/// Nodes on supports are eliminated; the others count body by body and row by row. If `closedNodes` is the
/// number of nodes in contact, u is the solution of the contact problem: on both model problems the contact
/// zone begins at (1,0) and is in one piece. Precondition: 0 < closedNodes ≤ elements + 1.
LinearSystem closedMembranes(const MembraneChoice& choice);

} // namespace epafi::drivers
