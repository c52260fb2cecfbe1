#include "epafi/model/ConnectedParts.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

namespace epafi::model {
namespace {

/// Connected pieces of the parts: the piece of every element, pieces numbered from 0, and their sizes.
struct Pieces {
  std::vector<int> of;
  std::vector<std::size_t> size;
};

Pieces findPieces(const fem::Mesh& mesh, const std::vector<int>& part) {
  Pieces pieces{std::vector<int>(part.size(), -1), {}};
  std::vector<GlobalOrdinal> stack, adjacent;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (pieces.of[seed] >= 0)
      continue;
    const auto piece = static_cast<int>(pieces.size.size());
    pieces.size.push_back(0);
    pieces.of[seed] = piece;
    stack.assign(1, static_cast<GlobalOrdinal>(seed));
    while (!stack.empty()) {
      const GlobalOrdinal element = stack.back();
      stack.pop_back();
      ++pieces.size.back();
      mesh.elementNeighbours(element, adjacent);
      for (const GlobalOrdinal other : adjacent)
        if (pieces.of[static_cast<std::size_t>(other)] < 0 &&
            part[static_cast<std::size_t>(other)] == part[seed]) {
          pieces.of[static_cast<std::size_t>(other)] = piece;
          stack.push_back(other);
        }
    }
  }
  return pieces;
}

/// The largest piece of every part, the first of equals; −1 where a part has none.
std::vector<int> largestPieces(const std::vector<int>& part, const Pieces& pieces) {
  const int numParts = part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1;
  std::vector<int> largest(static_cast<std::size_t>(numParts), -1);
  for (std::size_t element = 0; element < part.size(); ++element) {
    int& best = largest[static_cast<std::size_t>(part[element])];
    const int piece = pieces.of[element];
    if (best < 0 ||
        pieces.size[static_cast<std::size_t>(piece)] > pieces.size[static_cast<std::size_t>(best)])
      best = piece;
  }
  return largest;
}

/// The elements of all pieces that are not the largest of their part, piece by piece.
std::vector<GlobalOrdinal> strayElements(const std::vector<int>& part, const Pieces& pieces) {
  const std::vector<int> largest = largestPieces(part, pieces);
  std::vector<GlobalOrdinal> stray;
  for (std::size_t element = 0; element < part.size(); ++element)
    if (largest[static_cast<std::size_t>(part[element])] != pieces.of[element])
      stray.push_back(static_cast<GlobalOrdinal>(element));
  std::stable_sort(stray.begin(), stray.end(), [&](GlobalOrdinal a, GlobalOrdinal b) {
    return pieces.of[static_cast<std::size_t>(a)] < pieces.of[static_cast<std::size_t>(b)];
  });
  return stray;
}

/// The part with which a piece shares most facets, the lowest of equals; nothing if it has no neighbours, or if
/// one of them has moved.
std::optional<int> bestNeighbour(const fem::Mesh& mesh, const std::vector<int>& part, const Pieces& pieces,
                                 const std::vector<char>& moved, std::span<const GlobalOrdinal> piece) {
  std::vector<int> neighbours; // one entry a facet
  std::vector<GlobalOrdinal> adjacent;
  for (const GlobalOrdinal element : piece) {
    mesh.elementNeighbours(element, adjacent);
    for (const GlobalOrdinal neighbour : adjacent) {
      const auto other = static_cast<std::size_t>(neighbour);
      if (pieces.of[other] == pieces.of[static_cast<std::size_t>(element)])
        continue;
      if (moved[static_cast<std::size_t>(pieces.of[other])] != 0)
        return std::nullopt;
      neighbours.push_back(part[other]);
    }
  }
  std::sort(neighbours.begin(), neighbours.end());
  std::optional<int> best;
  std::ptrdiff_t mostFacets = 0;
  for (auto run = neighbours.begin(); run != neighbours.end();) {
    const auto end = std::upper_bound(run, neighbours.end(), *run);
    if (end - run > mostFacets) {
      mostFacets = end - run;
      best = *run;
    }
    run = end;
  }
  return best;
}

} // namespace

void makeConnected(const fem::Mesh& mesh, std::vector<int>& part) {
  for (bool anyMoved = true; anyMoved;) {
    anyMoved = false;
    const Pieces pieces = findPieces(mesh, part);
    const std::vector<GlobalOrdinal> stray = strayElements(part, pieces);
    // Neighbouring strays move one after the other, in different rounds: two could swap places for ever.
    std::vector<char> moved(pieces.size.size(), 0);
    for (auto first = stray.begin(); first != stray.end();) {
      const auto piece = static_cast<std::size_t>(pieces.of[static_cast<std::size_t>(*first)]);
      const auto end = first + static_cast<std::ptrdiff_t>(pieces.size[piece]);
      if (const auto target = bestNeighbour(mesh, part, pieces, moved, {first, end})) {
        for (auto element = first; element != end; ++element)
          part[static_cast<std::size_t>(*element)] = *target;
        moved[piece] = 1;
        anyMoved = true;
      }
      first = end;
    }
  }
}

} // namespace epafi::model
