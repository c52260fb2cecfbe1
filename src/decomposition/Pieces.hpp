#pragma once

/// What the steps of the decomposition share: this rank's subdomains with their topology, before unknowns are
/// numbered.

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/SubdomainAssembly.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace epafi::decomposition {

/// The nodes of a piece that other parts of its body share, and these parts.
class Sharing {
public:
  Sharing() = default;
  Sharing(const BodyLayout& body, const fem::AssembledSubdomain& piece);
  /// \param nodes  places of the shared nodes, ascending
  /// \param parts  of each of them, ascending
  Sharing(std::vector<std::size_t> nodes, const std::vector<std::vector<int>>& parts);

  /// Number of shared nodes.
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// Place of a shared node among the nodes of the piece, ascending with k.
  [[nodiscard]] std::size_t node(std::size_t k) const { return nodes_[k]; }
  /// Parts at a shared node, ascending; the piece's own part is among them.
  [[nodiscard]] std::span<const int> parts(std::size_t k) const {
    return {parts_.data() + start_[k], parts_.data() + start_[k + 1]};
  }
  /// The k of a node of the piece; nothing if no other part has it.
  [[nodiscard]] std::optional<std::size_t> find(std::size_t node) const;
  /// Whether no lower part than `part`, the piece's own, has the node.
  [[nodiscard]] bool isLowest(int part, std::size_t node) const;

private:
  std::vector<std::size_t> nodes_, start_{0};
  std::vector<int> parts_;
};

/// An entry of B that is still named by its global row.
struct RowEntry {
  GlobalOrdinal row; ///< index of the multiplier
  int unknown;
  double coefficient;
};

/// The average of u along an edge of a piece, component by component, in the place of its carrier's values.
struct EdgeAverage {
  std::size_t carrier = 0;         ///< place of a node
  std::vector<std::size_t> others; ///< places of the other nodes, ascending
};

/// One of this rank's subdomains.
struct Piece {
  int body = 0, part = 0, number = 0;
  fem::AssembledSubdomain assembled;             ///< without its stiffness
  std::shared_ptr<const SparseMatrix> stiffness; ///< equal pieces share one
  Sharing sharing;
  std::vector<std::size_t>
      chosen; ///< places of nodes that are to be crosspoints whatever else is; one piece may name them
  std::vector<char> isCrosspoint; ///< for each node
  std::vector<EdgeAverage> averages;
  std::vector<RowEntry> rows; ///< B^s
};

/// The bodies' layouts and physics, and how subdomains go to ranks: rank r of P has the numbers [rN/P,
/// (r+1)N/P).
struct Layout {
  const std::vector<BodyLayout>& bodies;
  std::vector<std::unique_ptr<fem::BodyModel>> models;
  int numSubdomains = 0;
};

/// A body as the steps that follow the assembly see it. Points and boundary are asked for at nodes of this rank's pieces.
struct BodyOutline {
  int dimension = 2;  ///< of space
  int components = 1; ///< unknowns a node
  int firstSubdomain = 0;
  GlobalOrdinal numNodes = 0; ///< nodes are numbered below
  std::function<fem::Point(GlobalOrdinal)> point;
  std::function<bool(GlobalOrdinal)> isBoundaryNode;
};

struct Outline {
  std::vector<BodyOutline> bodies;
  int numSubdomains = 0;
};

/// Keeps references to the meshes.
Outline outlineOf(const Layout& layout);

/// Body of a subdomain. Precondition: 0 ≤ number < layout.numSubdomains.
int bodyOf(const Layout& layout, int number);

/// Assembles this rank's subdomains, in the order of their numbers. \throws Error if K R of an elastic body is not 0. Not
/// collective.
std::vector<Piece> assemblePieces(const Layout& layout, const Comm& comm);

/// Rows of B by their global indices.
struct Rows {
  std::vector<GlobalOrdinal> owned; ///< rows that this rank owns
  std::vector<GlobalOrdinal>
      touched; ///< rows in which this rank's subdomains have entries, some perhaps twice
};

} // namespace epafi::decomposition
