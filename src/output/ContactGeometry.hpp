#pragma once

/// Where and on what area the multipliers of a contact act.

#include "epafi/output/SolvedScene.hpp"

#include <array>
#include <vector>

namespace epafi::output {

/// Each row's share of the area of contact `contact`: λ divided by it is the contact pressure. Of plane bodies the share of
/// the length times the thickness of the elements there, of membranes the length alone. In the order of the contact's rows,
/// whole on every rank. Not collective.
std::vector<double> pressureAreas(const SolvedScene& solved, int contact);

/// Direction from the first body to the other side at a row; deflections of membranes are along z.
std::array<double, 3> directionOf(const contact::ContactLayout& contact, std::size_t row);

} // namespace epafi::output
