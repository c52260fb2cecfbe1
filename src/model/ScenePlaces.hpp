#pragma once

/// Where the rows of a scene's contacts lie.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/decomposition/ContactPlace.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/model/BodyLayout.hpp"

#include <memory>
#include <vector>

namespace epafi::model {

/// Of those rows of this rank that a floating body takes part in; of scalar fields none.
/// \param rows  of the contact matrix
/// Not collective.
std::vector<decomposition::ContactPlace>
contactPlaces(const std::vector<BodyLayout>& bodies, const std::vector<contact::ContactLayout>& contacts,
              const std::vector<std::unique_ptr<fem::BodyModel>>& models, const Map& rows);

} // namespace epafi::model
