#pragma once

/// Steps of a deck.

#include "epafi/deck/Reading.hpp"

namespace epafi::deck {

void readHeading(Reading& reading, const Card& card);
void readStep(Reading& reading, const Card& card);
void readStatic(Reading& reading, const Card& card);
void readEndStep(Reading& reading, const Card& card);
void readNodePrint(Reading& reading, const Card& card);
void readElementPrint(Reading& reading, const Card& card);
void readContactPrint(Reading& reading, const Card& card);
void readSectionPrint(Reading& reading, const Card& card);

} // namespace epafi::deck
