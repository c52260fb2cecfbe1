#pragma once

/// From cards to a deck.

#include "epafi/deck/Cards.hpp"

#include <string>

namespace epafi::deck {

/// \throws InputError  of the first thing that is wrong or beyond what Epafi solves
Deck deckOf(const Cards& cards, const std::string& name);

} // namespace epafi::deck
