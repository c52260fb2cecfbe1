#pragma once

/// What the forces between bodies come to: balance of the two sides of contacts, and the forces in tied
/// joints.

#include "epafi/base/Slab.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <string>
#include <vector>

namespace epafi::simulation {

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

/// How the forces on the two sides of a contact or a tie balance.
struct JointBalance {
  std::string coupling;         ///< how they are coupled, in words
  double force = 0, moment = 0; ///< imbalance, beside Σ|λ| and its product with the size of the surface
};
/// Collective.
JointBalance balanceOf(const SolvedScene& solved, const contact::ContactLayout& layout);

/// What a tied joint carries.
struct TieResult {
  std::string name;
  GlobalOrdinal nodes = 0;
  std::array<double, 3> resultant{}; ///< on the scene's first body; of membranes in z
  double largestTraction = 0;        ///< force per area of a node
  std::string note;
  JointBalance balance;
};

/// Of each tied joint. Collective.
std::vector<TieResult> tieResults(const SolvedScene& solved);

} // namespace epafi::simulation
