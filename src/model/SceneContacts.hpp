#pragma once

/// The contacts of a scene: nodes that may meet, and their rows of B_I.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/scene/Scene.hpp"

#include <memory>
#include <vector>

namespace epafi::model {

/// Numbers the rows contact after contact, each by ascending nodes of the first body. A node may take part in several
/// contacts, each with a row of its own; a row that says what one of an earlier contact says (see contact/KnownRows.hpp) is left
/// out. \throws InputError if the edges of a pair do not coincide node by node (see scene::coincide), if one of them is
/// supported, if two pairs share an edge of a body (a common corner is fine), if a surface is not there, or if a contact adds no
/// row to those before; SolvabilityError if two contacts leave a node no room. Not collective (every rank finds the same).
std::vector<contact::ContactLayout> layoutContacts(const scene::Scene& scene,
                                                   const std::vector<BodyLayout>& bodies);

/// The rows of one contact; `firstRow` is left to the caller. Not collective.
contact::ContactLayout layoutContact(const scene::SurfaceContact& terms,
                                     const std::vector<BodyLayout>& bodies, int components);

/// The rows as a matrix; each lies on the rank that has the lowest subdomain at its first node. Collective.
contact::ContactMatrix contactMatrix(const std::vector<BodyLayout>& bodies,
                                     const std::vector<contact::ContactLayout>& contacts,
                                     const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                                     const RCP<const Comm>& comm);

} // namespace epafi::model
