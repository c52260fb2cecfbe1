#include "epafi/decomposition/Pieces.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <utility>

namespace epafi::decomposition {

Sharing::Sharing(const BodyLayout& body, std::span<const GlobalOrdinal> nodes) {
  start_.reserve(nodes.size() + 1);
  parts_.reserve(nodes.size() + nodes.size() / 4);
  std::vector<GlobalOrdinal> elements;
  std::vector<int> parts;
  for (const GlobalOrdinal node : nodes) {
    body.mesh->nodeElements(node, elements);
    parts.clear();
    for (const GlobalOrdinal element : elements) {
      const int part = body.partition->partOf(element);
      if (std::find(parts.begin(), parts.end(), part) == parts.end())
        parts.push_back(part);
    }
    std::sort(parts.begin(), parts.end());
    parts_.insert(parts_.end(), parts.begin(), parts.end());
    start_.push_back(parts_.size());
  }
}

int bodyOf(const Layout& layout, int number) {
  const auto next =
      std::upper_bound(layout.bodies.begin(), layout.bodies.end(), number,
                       [](int wanted, const BodyLayout& body) { return wanted < body.firstSubdomain; });
  return static_cast<int>(next - layout.bodies.begin()) - 1;
}

std::vector<Piece> assemblePieces(const Layout& layout, const Comm& comm) {
  const auto first = [&](GlobalOrdinal rank) {
    return static_cast<int>(rank * layout.numSubdomains / comm.getSize());
  };
  std::vector<Piece> pieces;
  for (int number = first(comm.getRank()); number < first(comm.getRank() + 1); ++number) {
    Piece piece;
    piece.number = number;
    piece.body = bodyOf(layout, number);
    const auto b = static_cast<std::size_t>(piece.body);
    const BodyLayout& body = layout.bodies[b];
    piece.part = number - body.firstSubdomain;
    piece.assembled = fem::assemble(*layout.models[b], body.partition->elementsOf(piece.part));
    piece.sharing = Sharing(body, piece.assembled.nodes);
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

} // namespace epafi::decomposition
