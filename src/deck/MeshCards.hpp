#pragma once

/// Nodes, elements, sets and surfaces of a deck.

#include "epafi/deck/Reading.hpp"

#include <vector>

namespace epafi::deck {

/// *NODE and *ELEMENT of all cards, with the sets that they name, before anything else is read.
void readNodes(Reading& reading, const std::vector<Card>& cards);
void readElements(Reading& reading, const std::vector<Card>& cards); ///< after the nodes

/// *NSET and *ELSET of all cards, in order.
void readSets(Reading& reading, const std::vector<Card>& cards);

void readSurface(Reading& reading, const Card& card); ///< *SURFACE

} // namespace epafi::deck
