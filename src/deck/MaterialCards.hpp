#pragma once

/// Materials, orientations and sections of a deck.

#include "epafi/deck/Reading.hpp"

namespace epafi::deck {

void readMaterial(Reading& reading, const Card& card);
void readElastic(Reading& reading, const Card& card);
void readDensity(Reading& reading, const Card& card);
void readExpansion(Reading& reading, const Card& card);
void readOrientation(Reading& reading, const Card& card);
void readSolidSection(Reading& reading, const Card& card);
/// *SHELL SECTION and the like are refused, unless no element is in the set.
void readOtherSection(Reading& reading, const Card& card);

} // namespace epafi::deck
