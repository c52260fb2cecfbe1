#pragma once

/// What the steps of the decomposition share: this rank's subdomains with their topology, before unknowns are
/// numbered.

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/SubdomainAssembly.hpp"

#include <memory>
#include <span>
#include <vector>

namespace epafi::decomposition {

/// Parts of the body that share each node of a piece, ascending; the piece's own part is among them.
class Sharing {
public:
  /// \param nodes  of one piece
  Sharing(const BodyLayout& body, std::span<const GlobalOrdinal> nodes);
  Sharing() = default;
  [[nodiscard]] std::size_t size() const { return start_.size() - 1; }
  [[nodiscard]] std::span<const int> operator[](std::size_t node) const {
    return {parts_.data() + start_[node], parts_.data() + start_[node + 1]};
  }

private:
  std::vector<std::size_t> start_{0};
  std::vector<int> parts_;
};

/// One of this rank's subdomains.
struct Piece {
  int body = 0, part = 0, number = 0;
  fem::AssembledSubdomain assembled;
  Sharing sharing;
  std::vector<char> isCrosspoint; ///< for each node
};

/// The bodies' layouts and physics, and how subdomains go to ranks: rank r of P has the numbers [rN/P,
/// (r+1)N/P).
struct Layout {
  const std::vector<BodyLayout>& bodies;
  std::vector<std::unique_ptr<fem::BodyModel>> models;
  int numSubdomains = 0;
};

/// Body of a subdomain. Precondition: 0 ≤ number < layout.numSubdomains.
int bodyOf(const Layout& layout, int number);

/// Assembles this rank's subdomains, in the order of their numbers. Not collective.
std::vector<Piece> assemblePieces(const Layout& layout, const Comm& comm);

/// An entry of B that is still named by its global row.
struct RowEntry {
  std::size_t piece; ///< index among this rank's pieces
  GlobalOrdinal row; ///< index of the multiplier
  int unknown;
  double coefficient;
};

/// Rows of B that this rank's subdomains touch.
struct Rows {
  std::vector<RowEntry> entries;
  std::vector<GlobalOrdinal> owned; ///< rows that this rank owns
};

} // namespace epafi::decomposition
