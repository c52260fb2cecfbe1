#pragma once

/// From rows of contact and smooth surfaces to places.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/SmoothSurface.hpp"
#include "epafi/decomposition/ContactPlace.hpp"

namespace epafi::contact {

/// One side of a contact; refers to what it is made of.
struct SmoothSide {
  const SmoothSurface* surface;
  const NodePoints* pointAt;
};

/// Of a row. Where a side has an edge, the other's normal counts, where both do, the row's direction.
/// Precondition: of 2 or 3 components. Not collective.
decomposition::ContactPlace placeOf(const ContactLayout& contact, std::size_t row, const SmoothSide& first,
                                    const SmoothSide& second);

} // namespace epafi::contact
