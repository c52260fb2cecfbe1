#pragma once

/// The faces of a surface that face the other one, where it bends sharply.

#include "epafi/contact/MortarIntegrals.hpp"
#include "epafi/contact/SurfaceNodes.hpp"

#include <vector>

namespace epafi::contact {

/// Makes the normals at sharp bends of the first surface those of the facets that face the other side best,
/// with those that continue them. Returns of each node whether more than one face does so, and the normal is
/// their mean. \param nodes of the first surface
std::vector<char> faceOtherSide(const std::vector<MortarFacet>& facets, SurfaceNodes& nodes);

} // namespace epafi::contact
