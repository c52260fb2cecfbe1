#pragma once

/// Elements that hang together.

#include "epafi/base/Types.hpp"

#include <vector>

namespace epafi::mesh {

/// The connected pieces of `numElements` elements, by their lowest elements; in no order inside. Linear in
/// the number of neighbours.
/// \param neighbours  neighbours(element, found) overwrites `found` with the elements that an element is
/// joined with, each of which must be joined with it
template <class Neighbours>
std::vector<std::vector<GlobalOrdinal>> connectedElements(GlobalOrdinal numElements,
                                                          const Neighbours& neighbours) {
  std::vector<char> isReached(numElements, 0);
  std::vector<std::vector<GlobalOrdinal>> pieces;
  std::vector<GlobalOrdinal> found;
  for (GlobalOrdinal seed = 0; seed < numElements; ++seed) {
    if (isReached[seed] != 0)
      continue;
    std::vector<GlobalOrdinal>& piece = pieces.emplace_back(1, seed);
    isReached[seed] = 1;
    for (std::size_t next = 0; next < piece.size(); ++next) {
      neighbours(piece[next], found);
      for (const GlobalOrdinal other : found)
        if (isReached[other] == 0) {
          isReached[other] = 1;
          piece.push_back(other);
        }
    }
  }
  return pieces;
}

} // namespace epafi::mesh
