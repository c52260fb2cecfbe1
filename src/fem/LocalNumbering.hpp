#pragma once

/// The nodes of a subdomain and its elements in terms of them.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Cell.hpp"

#include <optional>
#include <span>
#include <vector>

namespace epafi::fem {

/// Says which of its nodes, in ascending order, the corners of a subdomain's elements are. Subdomains that
/// are shifted copies of each other, as most of those of a structured mesh are, share one numbering.
class LocalNumbering {
public:
  /// \param corners  nodes of the elements, in rows (Cell.hpp) of nodesPerElement; at least one
  LocalNumbering(std::span<const GlobalOrdinal> corners, int nodesPerElement);

  /// The first node of a subdomain with these corners, if it is numbered like this one.
  [[nodiscard]] std::optional<GlobalOrdinal> firstNodeIfShifted(std::span<const GlobalOrdinal> corners) const;

  /// Nodes of the subdomain that begins with `firstNode`, ascending.
  [[nodiscard]] std::vector<GlobalOrdinal> nodes(GlobalOrdinal firstNode) const;

  [[nodiscard]] std::size_t numNodes() const { return offsets_.size(); }
  [[nodiscard]] std::size_t numElements() const { return corners_.size() / nodesPerElement_; }
  [[nodiscard]] std::size_t nodesPerElement() const { return nodesPerElement_; }
  /// Place of each corner among the nodes, in rows.
  [[nodiscard]] std::span<const int> corners() const { return corners_; }
  /// The same for one element.
  [[nodiscard]] std::span<const int> elementNodes(std::size_t element) const {
    return mesh::withoutFilling(corners().subspan(element * nodesPerElement_, nodesPerElement_));
  }
  /// Whether a corner only fills its row up.
  [[nodiscard]] bool isFilling(std::size_t corner) const {
    return corner > 0 && corners_[corner] == corners_[corner - 1] && corner % nodesPerElement_ > 0;
  }
  /// Elements of the subdomain that touch each node.
  [[nodiscard]] std::span<const int> numElementsAt() const { return numElementsAt_; }

private:
  std::size_t nodesPerElement_;
  std::vector<GlobalOrdinal> offsets_; ///< of each node from the first one
  std::vector<int> corners_;
  std::vector<int> numElementsAt_;
};

} // namespace epafi::fem
