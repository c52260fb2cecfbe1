#pragma once

/// Planes of symmetry through a contact.
///
/// The mean normal of facets on one side of such a plane leaves it by up to half an element's angle. For the
/// row of contact that is no matter. A tangent perpendicular to that normal, though, would have what the
/// error leaves of the surfaces' approach as its only entry at the node: friction would hinder the approach,
/// through a coefficient as small as the error, which preconditioners overrate by its inverse square.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/SurfaceNodes.hpp"

#include <functional>
#include <vector>

namespace epafi::contact {

/// Directions, of length 1, along which supports hold a node of a body.
using HeldAxes = std::function<std::vector<Eigen::Vector3d>(int body, GlobalOrdinal node)>;

/// Fills ContactLayout::symmetryPlanes: a node lies in a plane if supports hold it across, but not along d
/// too, as a clamp would, if d leaves the plane by no more than facets' normals do, and if they hold likewise
/// a node that it faces and that lies in the same plane. Not collective.
/// \param own, other  points of the nodes of the layout's first and second body
void findSymmetryPlanes(const NodePoints& own, const NodePoints& other, const HeldAxes& heldAxes,
                        ContactLayout& contact);

} // namespace epafi::contact
