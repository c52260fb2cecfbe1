#pragma once

/// A mesh of one body as the decomposition sees it. Nodes and elements are numbered from 0; every query is
/// local (no communication) and cheap, so that each rank asks only about its own part of the body.

#include "epafi/base/Types.hpp"

#include <array>
#include <span>
#include <vector>

namespace epafi::fem {

/// A point in the plane or in space; unused coordinates are 0.
using Point = std::array<double, 3>;

class Mesh {
public:
  virtual ~Mesh() = default;

  [[nodiscard]] virtual GlobalOrdinal numNodes() const = 0;
  [[nodiscard]] virtual GlobalOrdinal numElements() const = 0;
  /// Nodes an element (the same for all elements of a mesh).
  [[nodiscard]] virtual int nodesPerElement() const = 0;
  [[nodiscard]] virtual Point point(GlobalOrdinal node) const = 0;
  /// Nodes of an element in the order of its shape functions (counter-clockwise in 2-D).
  virtual void elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const = 0;
  /// The same for many elements, one after the other; quickest where the elements ascend.
  virtual void elementNodes(std::span<const GlobalOrdinal> elements,
                            std::span<GlobalOrdinal> nodes) const = 0;
  /// Elements that touch a node, appended to nothing: `elements` is overwritten.
  virtual void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const = 0;
  /// How many elements touch each of some ascending nodes.
  virtual void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const = 0;
  /// Elements that share an edge (2-D) or a face (3-D) with an element: its neighbours in the dual graph.
  virtual void elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const = 0;
  [[nodiscard]] virtual bool isBoundaryNode(GlobalOrdinal node) const = 0;
};

} // namespace epafi::fem
