#pragma once

/// What load steps leave for those to come: all that a run needs to go on after them.

#include "epafi/simulation/RunResult.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace epafi::simulation {

/// What friction has slipped at a node, from where the scene begins.
struct NodeSlip {
  GlobalOrdinal contact = 0, body = 0, node = 0; ///< the first two by their places in the scene
  Vector3 slip{};
};

/// A support that the next step holds where this one has moved it.
struct HeldSupport {
  std::string body, name;
  std::map<GlobalOrdinal, Vector3> displacements; ///< of its nodes
};

/// The first steps of a scene, all of them solved.
struct StepsDone {
  std::vector<double> meshes; ///< of each body a number that tells its mesh, as it is cut, from others
  std::vector<StepResult> results;
  /// Of all nodes with friction, by contact, body and node: on rank 0, the others having none, or on all
  /// ranks.
  std::vector<NodeSlip> slip;
  std::vector<HeldSupport> held; ///< on all ranks
  bool changesRows = false;      ///< whether the next step has other multipliers, so that these are no start
  /// Whoever keeps them tells by these numbers that they belong to a scene: one of the scene, one of each
  /// step.
  std::vector<std::uint64_t> marks{};
};

} // namespace epafi::simulation
