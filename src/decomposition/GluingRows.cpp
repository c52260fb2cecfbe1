#include "epafi/decomposition/GluingRows.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::decomposition {
namespace {

/// One side of a row: `key` names the row on all ranks before it has a number.
struct RowSide {
  GlobalOrdinal key;
  std::size_t piece;
  int unknown;
};

struct Sides {
  std::vector<RowSide> lower, higher;
};

/// Copies a node can have at most, for the keys.
constexpr GlobalOrdinal maxCopies = 64;

Sides findSides(const Layout& layout, const std::vector<Piece>& pieces) {
  std::vector<GlobalOrdinal> firstKey{0};
  for (const BodyLayout& body : layout.bodies)
    firstKey.push_back(firstKey.back() + body.mesh->numNodes());
  Sides sides;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Piece& piece = pieces[p];
    const int components = layout.models[static_cast<std::size_t>(piece.body)]->components();
    for (std::size_t i = 0; i < piece.assembled.nodes.size(); ++i) {
      const std::span<const int> parts = piece.sharing[i];
      if (parts.size() < 2 || piece.isCrosspoint[i] != 0)
        continue;
      const GlobalOrdinal node = firstKey[static_cast<std::size_t>(piece.body)] + piece.assembled.nodes[i];
      const auto place = std::find(parts.begin(), parts.end(), piece.part) - parts.begin();
      for (int c = 0; c < components; ++c) {
        const int unknown =
            piece.assembled.unknownOf[i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)];
        if (unknown < 0)
          continue;
        const auto key = [&](std::ptrdiff_t link) { return (node * maxCopies + link) * components + c; };
        if (place + 1 < static_cast<std::ptrdiff_t>(parts.size()))
          sides.lower.push_back({key(place), p, unknown});
        if (place > 0)
          sides.higher.push_back({key(place - 1), p, unknown});
      }
    }
  }
  return sides;
}

RCP<const Map> mapOfKeys(const std::vector<RowSide>& sides, const RCP<const Comm>& comm) {
  std::vector<GlobalOrdinal> keys;
  for (const RowSide& side : sides)
    keys.push_back(side.key);
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(keys), 0, comm));
}

} // namespace

Rows gluingRows(const Layout& layout, const std::vector<Piece>& pieces, GlobalOrdinal firstRow,
                const RCP<const Comm>& comm, GlobalOrdinal& numRows) {
  const Sides sides = findSides(layout, pieces);

  // Rows before those of each subdomain; one number a subdomain on every rank.
  std::vector<double> before(static_cast<std::size_t>(layout.numSubdomains) + 1, 0.0);
  for (const RowSide& side : sides.lower)
    before[static_cast<std::size_t>(pieces[side.piece].number) + 1] += 1;
  sumOverRanks(*comm, before);
  for (std::size_t s = 1; s < before.size(); ++s)
    before[s] += before[s - 1];
  numRows = static_cast<GlobalOrdinal>(before.back());

  Rows rows;
  Vector numbers(mapOfKeys(sides.lower, comm)), known(mapOfKeys(sides.higher, comm));
  for (std::size_t k = 0; k < sides.lower.size(); ++k) {
    double& next = before[static_cast<std::size_t>(pieces[sides.lower[k].piece].number)];
    numbers.replaceLocalValue(static_cast<LocalOrdinal>(k), next); // exact: far below 2^53
    const GlobalOrdinal row = firstRow + static_cast<GlobalOrdinal>(next);
    rows.owned.push_back(row);
    rows.entries.push_back({sides.lower[k].piece, row, sides.lower[k].unknown, 1.0});
    next += 1;
  }
  const Import plan(numbers.getMap(), known.getMap());
  known.doImport(numbers, plan, Tpetra::INSERT);
  const auto values = known.getData();
  for (std::size_t k = 0; k < sides.higher.size(); ++k)
    rows.entries.push_back({sides.higher[k].piece,
                            firstRow + static_cast<GlobalOrdinal>(values[static_cast<Teuchos_Ordinal>(k)]),
                            sides.higher[k].unknown, -1.0});
  return rows;
}

} // namespace epafi::decomposition
