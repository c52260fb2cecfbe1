#pragma once

/// Contact, joints and bolts of a deck, and what steps change of them.

#include "epafi/deck/Reading.hpp"

namespace epafi::deck {

void readInteraction(Reading& reading, const Card& card); ///< *SURFACE INTERACTION
void readSurfaceBehavior(Reading& reading, const Card& card);
void readFriction(Reading& reading, const Card& card); ///< of an interaction, or behind a *CHANGE FRICTION
void readContactPair(Reading& reading, const Card& card);
void readTie(Reading& reading, const Card& card);
void readPretension(Reading& reading, const Card& card);

void readFrictionChange(Reading& reading, const Card& card);
void readModelChange(Reading& reading, const Card& card);

} // namespace epafi::deck
