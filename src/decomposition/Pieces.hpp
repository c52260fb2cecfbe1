#pragma once

/// What the steps of the decomposition share: this rank's subdomains with their topology, before unknowns are numbered.

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/SubdomainAssembly.hpp"

#include <memory>
#include <vector>

namespace epafi::decomposition {

/// One of this rank's subdomains.
struct Piece {
  int body = 0, part = 0, number = 0;
  fem::AssembledSubdomain assembled;
  std::vector<std::vector<int>> sharing; ///< parts of the body that share each node, ascending (this one among them)
  std::vector<char> isCrosspoint;        ///< for each node
};

/// The bodies' layouts and physics, and how subdomains go to ranks: rank r of P has the numbers [rN/P, (r+1)N/P).
struct Layout {
  const std::vector<BodyLayout>& bodies;
  std::vector<std::unique_ptr<fem::BodyModel>> models;
  int numSubdomains = 0;
};

/// An entry of B that is still named by its global row.
struct RowEntry {
  std::size_t piece;   ///< index among this rank's pieces
  GlobalOrdinal row;   ///< index of the multiplier
  int unknown;
  double coefficient;
};

/// Rows of B that this rank's subdomains touch.
struct Rows {
  std::vector<RowEntry> entries;
  std::vector<GlobalOrdinal> owned; ///< rows that this rank owns
};

} // namespace epafi::decomposition
