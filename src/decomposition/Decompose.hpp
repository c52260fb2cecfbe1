#pragma once

/// From a scene to a DecomposedProblem.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/decomposition/Partition.hpp"
#include "epafi/fem/RectangleMesh.hpp"
#include "epafi/scene/Scene.hpp"

#include <memory>
#include <vector>

namespace epafi::decomposition {

/// A body of the scene with its mesh and the way it is cut.
struct BodyLayout {
  std::string name;
  std::unique_ptr<fem::RectangleMesh> mesh;
  std::shared_ptr<const Partition> partition; ///< bodies that are meshed and cut alike share one
  int firstSubdomain = 0;                     ///< number of its part 0 in the whole problem
};

/// A contact pair of the scene: its rows of B_I and its nodes on the first body's edge, in the same order.
struct ContactLayout {
  std::string name;
  GlobalOrdinal firstRow = 0; ///< multiplier index of its first row
  GlobalOrdinal numRows = 0;
  int firstBody = 0, secondBody = 0;
  scene::Edge firstEdge = scene::Edge::right, secondEdge = scene::Edge::left;
  double gap = 0;
};

/// The scene cut into subdomains: where everything lies (for output), and the problem itself (for FETI-DP).
struct Decomposition {
  std::vector<BodyLayout> bodies;
  std::vector<ContactLayout> contacts;
  DecomposedProblem problem;
};

/// Cuts the scene into subdomains, gives each rank a contiguous run of them and assembles them.
/// Collective. \throws InputError (the same on all ranks) if contact edges do not match, or if a contact edge
/// is supported.
Decomposition decompose(const scene::Scene& scene, const RCP<const Comm>& comm);

} // namespace epafi::decomposition
