#include "epafi/decomposition/GluingRows.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/SharedValues.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <span>

namespace epafi::decomposition {
namespace {

/// A piece's side of the rows at one node, one row a free component, between it and the next higher or lower
/// part there.
struct Side {
  std::size_t piece = 0;
  GlobalOrdinal node = 0;
  std::size_t place = 0; ///< of the node in the piece's Sharing
  int link = 0;          ///< place of the lower part among those at the node
  int otherNumber = 0;   ///< of the subdomain on the other side
  int firstUnknown = 0;  ///< of the node's free components in the piece
  int numRows = 0;
  GlobalOrdinal firstRow = 0;
};

/// In the order of the pieces and, in each, of the nodes.
struct Sides {
  std::vector<Side> lower, higher;
};

Sides findSides(const Outline& outline, const std::vector<Piece>& pieces) {
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
    const int firstSubdomain = outline.bodies[b].firstSubdomain;
    const auto components = static_cast<std::size_t>(outline.bodies[b].components);
    for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
      const std::span<const int> parts = piece.sharing.parts(k);
      const std::size_t node = piece.sharing.node(k);
      if (parts.size() < 2 || piece.isCrosspoint[node] != 0)
        continue;
      Side side{p, piece.assembled.nodes[node], k};
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
GlobalOrdinal numberRows(const Outline& outline, const std::vector<Piece>& pieces, GlobalOrdinal firstRow,
                         const Comm& comm, std::vector<Side>& lower) {
  // Rows before those of each subdomain; one number a subdomain on every rank, exact: far below 2^53.
  std::vector<double> before(static_cast<std::size_t>(outline.numSubdomains) + 1, 0.0);
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
RCP<const Map> mapOfKeys(const Outline& outline, const std::vector<Piece>& pieces,
                         const std::vector<Side*>& sides, const RCP<const Comm>& comm) {
  const std::vector<GlobalOrdinal> firstKey = firstNodesOf(outline);
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
void findRowsElsewhere(const Outline& outline, const std::vector<Piece>& pieces, const RCP<const Comm>& comm,
                       Sides& sides) {
  if (comm->getSize() == 1)
    return;
  const std::vector<Side*> lower = elsewhere(pieces, sides.lower), higher = elsewhere(pieces, sides.higher);
  Vector numbers(mapOfKeys(outline, pieces, lower, comm)), known(mapOfKeys(outline, pieces, higher, comm));
  for (std::size_t k = 0; k < lower.size(); ++k)
    numbers.replaceLocalValue(static_cast<LocalOrdinal>(k), static_cast<double>(lower[k]->firstRow));
  const Import plan(numbers.getMap(), known.getMap());
  known.doImport(numbers, plan, Tpetra::INSERT);
  const auto values = known.getData();
  for (std::size_t k = 0; k < higher.size(); ++k)
    higher[k]->firstRow = static_cast<GlobalOrdinal>(values[static_cast<Teuchos_Ordinal>(k)]);
}

void enter(const Side& side, double coefficient, Piece& piece) {
  for (int r = 0; r < side.numRows; ++r)
    piece.rows.push_back({side.firstRow + r, side.firstUnknown + r, coefficient});
}

/// The copies of nodes with three or more.
std::vector<SharedNode> nodesWithManyCopies(const Outline& outline, const std::vector<Piece>& pieces) {
  std::vector<SharedNode> nodes;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Piece& piece = pieces[p];
    const auto components =
        static_cast<std::size_t>(outline.bodies[static_cast<std::size_t>(piece.body)].components);
    for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
      const std::size_t node = piece.sharing.node(k);
      const auto unknowns = std::span(piece.assembled.unknownOf).subspan(node * components, components);
      if (piece.sharing.parts(k).size() >= 3 && piece.isCrosspoint[node] == 0 &&
          std::any_of(unknowns.begin(), unknowns.end(), [](int unknown) { return unknown >= 0; }))
        nodes.push_back({p, k});
    }
  }
  return nodes;
}

/// The weighted part of the rows at nodes with three or more copies: those of its own link and of the later ones, which it
/// adds to `touched`. Collective.
void enterMeans(const Outline& outline, const std::vector<Side>& lower, const RCP<const Comm>& comm,
                std::vector<Piece>& pieces, std::vector<GlobalOrdinal>& touched) {
  const std::vector<SharedNode> nodes = nodesWithManyCopies(outline, pieces);
  const auto numComponents = static_cast<std::size_t>(outline.bodies.front().components);
  const auto firstRow = static_cast<Eigen::Index>(numComponents); // column of the first row of a copy's link
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(nodes.size()), firstRow + 1);
  auto side = lower.begin(); // in the order of `nodes`, but the last copies have none
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Piece& piece = pieces[nodes[i].piece];
    const auto row = static_cast<Eigen::Index>(i);
    own.row(row).head(firstRow) = stiffnessOf(piece, piece.sharing.node(nodes[i].place), numComponents);
    if (piece.sharing.parts(nodes[i].place).back() == piece.part)
      continue;
    side = std::find_if(side, lower.end(), [&](const Side& s) {
      return s.piece == nodes[i].piece && s.place == nodes[i].place;
    });
    own(row, firstRow) = static_cast<double>(side->firstRow);
  }
  const std::vector<Eigen::MatrixXd> copies = valuesOfCopies(outline, pieces, nodes, own, comm);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    Piece& piece = pieces[nodes[i].piece];
    const std::span<const int> parts = piece.sharing.parts(nodes[i].place);
    const auto copy = std::find(parts.begin(), parts.end(), piece.part) - parts.begin();
    const auto unknowns = std::span(piece.assembled.unknownOf)
                              .subspan(piece.sharing.node(nodes[i].place) * numComponents, numComponents);
    for (Eigen::Index link = copy; link + 1 < copies[i].rows(); ++link) {
      auto row = static_cast<GlobalOrdinal>(copies[i](link, firstRow));
      for (std::size_t c = 0; c < numComponents; ++c)
        if (unknowns[c] >= 0) {
          const auto stiffness = copies[i].col(static_cast<Eigen::Index>(c));
          touched.push_back(row);
          piece.rows.push_back({row++, unknowns[c], stiffness[copy] / stiffness.head(link + 1).sum()});
        }
    }
  }
}

} // namespace

Rows gluingRows(const Outline& outline, std::vector<Piece>& pieces, GlobalOrdinal firstRow,
                const RCP<const Comm>& comm, GlobalOrdinal& numRows) {
  Sides sides = findSides(outline, pieces);
  numRows = numberRows(outline, pieces, firstRow, *comm, sides.lower);
  findRowsHere(pieces, sides.lower, sides.higher);
  findRowsElsewhere(outline, pieces, comm, sides);
  for (Piece& piece : pieces)
    piece.rows.reserve(piece.rows.size() + 2 * piece.sharing.size());
  for (const Side& side : sides.lower)
    if (Piece& piece = pieces[side.piece]; piece.sharing.parts(side.place).size() == 2)
      enter(side, 1.0, piece);
  for (const Side& side : sides.higher)
    enter(side, -1.0, pieces[side.piece]);

  Rows rows;
  for (const Side& side : sides.lower)
    for (int r = 0; r < side.numRows; ++r)
      rows.owned.push_back(side.firstRow + r);
  rows.touched = rows.owned;
  for (const Side& side : sides.higher)
    if (!isHere(pieces, side.otherNumber))
      for (int r = 0; r < side.numRows; ++r)
        rows.touched.push_back(side.firstRow + r);
  if (!outline.bodies.empty())
    enterMeans(outline, sides.lower, comm, pieces, rows.touched);
  return rows;
}

} // namespace epafi::decomposition
