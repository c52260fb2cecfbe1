#pragma once

/// Contacts of a scene that are laid out as one, as their surfaces go on in each other.

#include "epafi/model/BodyLayout.hpp"
#include "epafi/scene/Scene.hpp"

#include <cstddef>
#include <vector>

namespace epafi::model {

struct ContactGroup {
  std::vector<int> numbers; ///< of the scene's contacts, ascending
  /// The same, with the same bodies first and second. Each of the first one's surfaces has facets that those
  /// before it have not; what two of them have belongs to the earlier one.
  std::vector<scene::SurfaceContact> terms;
  bool mayEitherCarry = true; ///< whether that holds of the second one's surfaces, too
};

/// Contacts, or ties, between the same bodies, or a body and the same obstacle, that ask for the same gap,
/// distance and coupling, and whose surfaces have nodes in common at which neither of them bends sharply;
/// each contact is in one group, in the order of the scene. What they share is one row then, of which each
/// has its part by area. \throws InputError if a contact says what another one says with the sides exchanged
/// or with other words, or if two that are no group have facets in common on both sides. Not collective.
std::vector<ContactGroup> contactGroups(const scene::Scene& scene, const std::vector<BodyLayout>& bodies);

} // namespace epafi::model
