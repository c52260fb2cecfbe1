#pragma once

/// What the forces between bodies come to: balance of the two sides of contacts, and the forces in tied joints.

#include "epafi/output/SolvedScene.hpp"

#include <Teuchos_ParameterList.hpp>

namespace epafi::output {

/// Adds to a report:
///   Contact/NAME  of contacts between bodies: Coupling (in words), Force Imbalance and Moment Imbalance of the two sides, beside
///                 the sum of the forces and its product with the size of the surface
///   Tied/NAME     Nodes, Resultant (the force on the scene's first body; of membranes in z), Largest Traction (force per area of a
///                 node), Coupling, Force Imbalance, Moment Imbalance
/// Collective.
void addJoints(const SolvedScene& solved, Teuchos::ParameterList& report);

} // namespace epafi::output
