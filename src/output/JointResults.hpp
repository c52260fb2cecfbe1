#pragma once

/// What the forces between bodies come to: balance of the two sides of contacts, and the forces in tied
/// joints.

#include "epafi/output/Slab.hpp"
#include "epafi/output/SolvedScene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <vector>

namespace epafi::output {

/// The fields of a tied joint, each rank holding a contiguous slab of its nodes, those of the side that has
/// the multipliers.
struct TieFields {
  GlobalOrdinal numNodes = 0;
  RowRange nodes;               ///< this rank's
  std::vector<double> points;   ///< 3 a node
  std::vector<double> traction; ///< force per area on the joint's other side, 3 a node
};

/// Collective. Precondition: the solution's vectors lie on the problem's multiplierMap.
TieFields gatherTieFields(const SolvedScene& solved, const contact::ContactLayout& tie);

/// The size of a contact's resultant, and how it depends on the forces of the rows: value = Σ gᵀλ, g what a
/// motion of the first body along the resultant takes of the rows' gaps; 0 where there is no force. On
/// multiplierMap.
struct ContactForce {
  double value = 0;
  RCP<Vector> weights; ///< g
};
/// Collective.
ContactForce contactForce(const SolvedScene& solved, const contact::ContactLayout& layout);

/// Adds to a report:
///   Contact/NAME of contacts between bodies: Coupling (in words), Force Imbalance and Moment Imbalance of
///   the two sides, beside
///                 the sum of the forces and its product with the size of the surface
///   Tied/NAME Nodes, Resultant (the force on the scene's first body; of membranes in z), Largest Traction
///   (force per area of a
///                 node), Coupling, Force Imbalance, Moment Imbalance
/// Collective.
void addJoints(const SolvedScene& solved, Teuchos::ParameterList& report);

} // namespace epafi::output
