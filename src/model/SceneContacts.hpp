#pragma once

/// The contacts of a scene: nodes that may meet, and their rows of B_I.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <vector>

namespace epafi::model {

/// The contacts of a scene, and its tied joints, whose rows are numbered for themselves; those with a preload
/// apart, without numbers.
struct SceneContacts {
  std::vector<contact::ContactLayout> contacts, ties, sections;
};

/// What contacts have to know of supports and bodies; empty functions: nothing.
struct SupportedNodes {
  /// Whether they hold a node of a body in a direction.
  std::function<bool(int body, GlobalOrdinal node, const Eigen::Vector3d& direction)> isHeld;
  /// Directions along which they hold a node of an elastic body, of length 1.
  std::function<std::vector<Eigen::Vector3d>(int body, GlobalOrdinal node)> heldAxes;
  /// Axes (columns) along which they hold the nodes of a surface: the frame of that which is held most.
  std::function<Eigen::Matrix3d(int body, const mesh::Surface& surface)> axes;
  /// Thicknesses of a plane body at the facets of a surface; empty of other bodies.
  std::function<std::vector<double>(int body, const mesh::Surface& surface)> thicknesses;
  bool areOfRevolution = false; ///< the bodies, about the y-axis
  /// Extent of a body along a direction.
  std::function<double(int body, const Eigen::Vector3d& direction)> extent;
};

/// Those of a scene; keeps a reference. Not collective.
SupportedNodes supportedNodes(const std::vector<std::unique_ptr<fem::BodyModel>>& models);

/// Numbers the rows contact after contact, each by ascending nodes of the first body. A node may take part in
/// several contacts, each with a row of its own; a row that says what one of an earlier contact says (see
/// contact/KnownRows.hpp) is left out. \throws InputError if the edges of a pair do not coincide node by node
/// (see scene::coincide), if one of them is supported, if two pairs share an edge of a body (a common corner
/// is fine), if a surface is not there, or if a contact adds no row to those before; SolvabilityError if two
/// contacts leave a node no room. Not collective (every rank finds the same).
SceneContacts layoutContacts(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                             const SupportedNodes& supports);

/// The rows of one contact or tied joint: of pairs of nodes where the surfaces match, else by mortars, whose
/// multipliers the first surface carries unless the terms say otherwise. `firstRow` is left to the caller.
/// Not collective.
contact::ContactLayout layoutContact(const scene::SurfaceContact& terms,
                                     const std::vector<BodyLayout>& bodies, int components,
                                     const SupportedNodes& supported = {});

/// What rows have to know of nodes; each row lies on the rank that has the lowest subdomain at its first
/// node. Keeps references to bodies and models. Collective.
contact::NodeUnknowns nodeUnknowns(const std::vector<BodyLayout>& bodies,
                                   const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                                   const RCP<const Comm>& comm);

} // namespace epafi::model
