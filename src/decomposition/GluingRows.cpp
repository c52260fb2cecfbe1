#include "epafi/decomposition/GluingRows.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::decomposition {
namespace {

/// Copies a node can have at most, for the keys.
constexpr GlobalOrdinal maxCopies = 64;

/// A piece's side of the rows at one node, one row a free component, between it and the next higher or lower
/// part there.
struct Side {
  std::size_t piece = 0;
  GlobalOrdinal node = 0;
  int link = 0;         ///< place of the lower part among those at the node
  int otherNumber = 0;  ///< of the subdomain on the other side
  int firstUnknown = 0; ///< of the node's free components in the piece
  int numRows = 0;
  GlobalOrdinal firstRow = 0;
};

/// In the order of the pieces and, in each, of the nodes.
struct Sides {
  std::vector<Side> lower, higher;
};

Sides findSides(const Layout& layout, const std::vector<Piece>& pieces) {
  std::size_t numShared = 0;
  for (const Piece& piece : pieces)
    numShared += piece.sharing.size();
  Sides sides;
  sides.lower.reserve(
      numShared); // about twice what a node with two copies takes; what is not used costs nothing
  sides.higher.reserve(numShared);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Piece& piece = pieces[p];
    const auto b = static_cast<std::size_t>(piece.body);
    const int firstSubdomain = layout.bodies[b].firstSubdomain;
    const auto components = static_cast<std::size_t>(layout.models[b]->components());
    for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
      const std::span<const int> parts = piece.sharing.parts(k);
      const std::size_t node = piece.sharing.node(k);
      if (parts.size() < 2 || piece.isCrosspoint[node] != 0)
        continue;
      Side side{p, piece.assembled.nodes[node]};
      for (const int unknown : std::span(piece.assembled.unknownOf).subspan(node * components, components))
        if (unknown >= 0 && side.numRows++ == 0)
          side.firstUnknown = unknown;
      if (side.numRows == 0)
        continue;
      const auto place = std::find(parts.begin(), parts.end(), piece.part);
      if (place + 1 != parts.end()) {
        side.link = static_cast<int>(place - parts.begin());
        side.otherNumber = firstSubdomain + *(place + 1);
        sides.lower.push_back(side);
      }
      if (place != parts.begin()) {
        side.link = static_cast<int>(place - parts.begin()) - 1;
        side.otherNumber = firstSubdomain + *(place - 1);
        sides.higher.push_back(side);
      }
    }
  }
  return sides;
}

/// Numbers the rows of the lower sides; returns how many there are on all ranks. Collective.
GlobalOrdinal numberRows(const Layout& layout, const std::vector<Piece>& pieces, GlobalOrdinal firstRow,
                         const Comm& comm, std::vector<Side>& lower) {
  // Rows before those of each subdomain; one number a subdomain on every rank, exact: far below 2^53.
  std::vector<double> before(static_cast<std::size_t>(layout.numSubdomains) + 1, 0.0);
  for (const Side& side : lower)
    before[static_cast<std::size_t>(pieces[side.piece].number) + 1] += side.numRows;
  sumOverRanks(comm, before);
  for (std::size_t s = 1; s < before.size(); ++s)
    before[s] += before[s - 1];
  if (!lower.empty()) { // this rank's subdomains follow each other, and so do their rows
    GlobalOrdinal next =
        firstRow + static_cast<GlobalOrdinal>(before[static_cast<std::size_t>(pieces.front().number)]);
    for (Side& side : lower) {
      side.firstRow = next;
      next += side.numRows;
    }
  }
  return static_cast<GlobalOrdinal>(before.back());
}

/// This rank's subdomains: the numbers of its pieces, which follow each other.
bool isHere(const std::vector<Piece>& pieces, int number) {
  return !pieces.empty() && pieces.front().number <= number && number <= pieces.back().number;
}

/// Higher sides whose lower one is on this rank get their rows from it.
void findRowsHere(const std::vector<Piece>& pieces, const std::vector<Side>& lower,
                  std::vector<Side>& higher) {
  std::vector<std::size_t> start(pieces.size() + 1, lower.size()); // of each piece's lower sides
  for (std::size_t k = lower.size(); k-- > 0;)
    start[lower[k].piece] = k;
  for (std::size_t p = pieces.size(); p-- > 0;)
    if (start[p] > start[p + 1])
      start[p] = start[p + 1];
  for (Side& side : higher) {
    if (!isHere(pieces, side.otherNumber))
      continue;
    const auto p = static_cast<std::size_t>(side.otherNumber - pieces.front().number);
    const auto begin = lower.begin() + static_cast<std::ptrdiff_t>(start[p]);
    const auto end = lower.begin() + static_cast<std::ptrdiff_t>(start[p + 1]);
    side.firstRow = std::lower_bound(begin, end, side.node, [](const Side& s, GlobalOrdinal node) {
                      return s.node < node;
                    })->firstRow;
  }
}

/// Names the sides on all ranks before the higher ones know their rows.
RCP<const Map> mapOfKeys(const Layout& layout, const std::vector<Piece>& pieces,
                         const std::vector<Side*>& sides, const RCP<const Comm>& comm) {
  std::vector<GlobalOrdinal> firstKey{0};
  for (const BodyLayout& body : layout.bodies)
    firstKey.push_back(firstKey.back() + body.mesh->numNodes());
  std::vector<GlobalOrdinal> keys;
  keys.reserve(sides.size());
  for (const Side* side : sides)
    keys.push_back((firstKey[static_cast<std::size_t>(pieces[side->piece].body)] + side->node) * maxCopies +
                   side->link);
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(keys), 0, comm));
}

std::vector<Side*> elsewhere(const std::vector<Piece>& pieces, std::vector<Side>& sides) {
  std::vector<Side*> result;
  for (Side& side : sides)
    if (!isHere(pieces, side.otherNumber))
      result.push_back(&side);
  return result;
}

/// Higher sides whose lower one is on another rank hear their rows from there. Collective.
void findRowsElsewhere(const Layout& layout, const std::vector<Piece>& pieces, const RCP<const Comm>& comm,
                       Sides& sides) {
  if (comm->getSize() == 1)
    return;
  const std::vector<Side*> lower = elsewhere(pieces, sides.lower), higher = elsewhere(pieces, sides.higher);
  Vector numbers(mapOfKeys(layout, pieces, lower, comm)), known(mapOfKeys(layout, pieces, higher, comm));
  for (std::size_t k = 0; k < lower.size(); ++k)
    numbers.replaceLocalValue(static_cast<LocalOrdinal>(k), static_cast<double>(lower[k]->firstRow));
  const Import plan(numbers.getMap(), known.getMap());
  known.doImport(numbers, plan, Tpetra::INSERT);
  const auto values = known.getData();
  for (std::size_t k = 0; k < higher.size(); ++k)
    higher[k]->firstRow = static_cast<GlobalOrdinal>(values[static_cast<Teuchos_Ordinal>(k)]);
}

void enter(const std::vector<Side>& sides, double coefficient, std::vector<Piece>& pieces) {
  for (const Side& side : sides)
    for (int r = 0; r < side.numRows; ++r)
      pieces[side.piece].rows.push_back({side.firstRow + r, side.firstUnknown + r, coefficient});
}

} // namespace

Rows gluingRows(const Layout& layout, std::vector<Piece>& pieces, GlobalOrdinal firstRow,
                const RCP<const Comm>& comm, GlobalOrdinal& numRows) {
  Sides sides = findSides(layout, pieces);
  numRows = numberRows(layout, pieces, firstRow, *comm, sides.lower);
  findRowsHere(pieces, sides.lower, sides.higher);
  findRowsElsewhere(layout, pieces, comm, sides);
  for (Piece& piece : pieces)
    piece.rows.reserve(piece.rows.size() + 2 * piece.sharing.size());
  enter(sides.lower, 1.0, pieces);
  enter(sides.higher, -1.0, pieces);

  Rows rows;
  for (const Side& side : sides.lower)
    for (int r = 0; r < side.numRows; ++r)
      rows.owned.push_back(side.firstRow + r);
  rows.touched = rows.owned;
  for (const Side& side : sides.higher)
    if (!isHere(pieces, side.otherNumber))
      for (int r = 0; r < side.numRows; ++r)
        rows.touched.push_back(side.firstRow + r);
  return rows;
}

} // namespace epafi::decomposition
