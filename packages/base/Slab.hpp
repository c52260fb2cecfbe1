#pragma once

/// Rows of a table that lies in contiguous pieces on the ranks: how everything goes to a file without ever
/// being whole on one rank.

#include "epafi/base/Types.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>

namespace epafi {

/// Rows [first, first + count) of a table.
struct RowRange {
  GlobalOrdinal first = 0;
  GlobalOrdinal count = 0;
};

/// The share of `rows` rows that one of several ranks has: contiguous, in the order of the ranks, sizes
/// differ by at most one.
inline RowRange evenShare(GlobalOrdinal rows, GlobalOrdinal rank, GlobalOrdinal ranks) {
  const GlobalOrdinal least = rows / ranks;
  const GlobalOrdinal longer = rows % ranks;
  return {rank * least + std::min(rank, longer), least + (rank < longer ? 1 : 0)};
}

/// The rank whose share a row is in.
inline int rankOfRow(GlobalOrdinal row, GlobalOrdinal rows, GlobalOrdinal ranks) {
  const GlobalOrdinal least = rows / ranks, longer = rows % ranks, inLonger = longer * (least + 1);
  return static_cast<int>(row < inLonger ? row / (least + 1) : longer + (row - inLonger) / least);
}

/// This rank's. Not collective.
inline RowRange evenShare(GlobalOrdinal rows, const Comm& comm) {
  return evenShare(rows, comm.getRank(), comm.getSize());
}

/// The rows, each rank with its share. Collective.
inline RCP<const Map> slabMap(GlobalOrdinal rows, const RCP<const Comm>& comm) {
  return rcp(new Map(static_cast<Tpetra::global_size_t>(rows),
                     static_cast<std::size_t>(evenShare(rows, *comm).count), 0, comm));
}

} // namespace epafi
