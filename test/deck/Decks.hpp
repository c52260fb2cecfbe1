#pragma once

/// Small decks that are right, to be read as they are or with more in them.

#include "epafi/deck/Deck.hpp"
#include "support/Refusal.hpp"

#include <string>

namespace epafi::test {

/// Four nodes and a tetrahedron of some material: nine lines, in front of what is tried.
inline const std::string tetrahedron = "*NODE, NSET=Nall\n"
                                       "1, 0, 0, 0\n"
                                       "2, 1, 0, 0\n"
                                       "3, 0, 1, 0\n"
                                       "4, 0, 0, 1\n"
                                       "*ELEMENT, TYPE=C3D4, ELSET=Eall\n"
                                       "1, 1, 2, 3, 4\n"
                                       "*NSET, NSET=base\n"
                                       "1, 2, 3\n";

inline deck::Deck deckOf(const std::string& text) {
  return deck::parseDeck(text, "a.inp");
}

inline deck::Deck withTetrahedron(const std::string& cards) {
  return deckOf(tetrahedron + cards);
}

/// A deck with the cards in its only step.
inline deck::Deck withStep(const std::string& cards) {
  return withTetrahedron("*STEP\n*STATIC\n" + cards + "*END STEP\n");
}

/// What is said of a deck with the tetrahedron, whose first card that is tried is in line 10.
inline std::string refusalWith(const std::string& cards) {
  return refusal([&] { (void)withTetrahedron(cards); });
}

/// The same of cards in a step, from line 12 on.
inline std::string refusalInStep(const std::string& cards) {
  return refusal([&] { (void)withStep(cards); });
}

} // namespace epafi::test
