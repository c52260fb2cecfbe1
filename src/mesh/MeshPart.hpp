#pragma once

/// A piece of a body's mesh, as one rank holds it where no rank is to hold the whole: some elements of its
/// own, those around their nodes, and those at the body's named surfaces. Numbers are those of the whole
/// mesh.

#include "epafi/mesh/Mesh.hpp"
#include "epafi/mesh/MeshTopology.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace epafi::mesh {

/// What a piece consists of.
struct PartArrays {
  CellType cellType = CellType::triangle;      ///< of the largest elements
  GlobalOrdinal numNodes = 0, numElements = 0; ///< of the whole body
  GlobalOrdinal numCorners = 0;                ///< nodes of the whole body that are corners of elements
  std::array<Point, 2> box{};                  ///< of all its nodes: lower and upper
  std::vector<GlobalOrdinal> elements, nodes;  ///< held ones, ascending
  std::vector<LocalOrdinal> cells;             ///< rows of the held elements, as places in `nodes`
  std::vector<Point> points;                   ///< of the held nodes
  std::vector<GlobalOrdinal> cornerNumbers;    ///< of the held nodes, among the body's corners; −1: none
  std::vector<std::uint8_t> isOnBoundary;      ///< of the held nodes
  std::vector<std::pair<std::string, Surface>> surfaces;                    ///< whole
  std::vector<std::pair<std::string, std::vector<GlobalOrdinal>>> groups;   ///< as far as held, ascending
  std::vector<std::pair<std::string, std::vector<GlobalOrdinal>>> nodeSets; ///< whole, ascending
};

/// Every query may be asked of held nodes and elements. Of nodes of the own elements it has the same answer
/// as of the whole mesh; at others elements may be missing, and the neighbours of elements that are not own
/// ones.
class MeshPart final : public Mesh {
public:
  explicit MeshPart(PartArrays arrays);

  [[nodiscard]] const MeshPart* part() const override { return this; }
  [[nodiscard]] const std::vector<GlobalOrdinal>& elements() const { return arrays_.elements; } ///< held ones
  [[nodiscard]] const std::vector<GlobalOrdinal>& nodes() const { return arrays_.nodes; }       ///< likewise
  [[nodiscard]] const std::array<Point, 2>& box() const { return arrays_.box; } ///< of the whole body
  /// The same elements of order 1, nodes numbered as the whole mesh's corners are.
  [[nodiscard]] std::unique_ptr<const MeshPart> ofOrder1() const;

  [[nodiscard]] CellType cellType() const override { return arrays_.cellType; }
  [[nodiscard]] GlobalOrdinal numNodes() const override { return arrays_.numNodes; }
  [[nodiscard]] GlobalOrdinal numElements() const override { return arrays_.numElements; }
  [[nodiscard]] Point point(GlobalOrdinal node) const override { return arrays_.points[placeOf(node)]; }
  void elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const override;
  void elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const override;
  /// Those held, ascending; none of a node that is not held.
  void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const override;
  void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const override;
  void elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const override;
  [[nodiscard]] bool isBoundaryNode(GlobalOrdinal node) const override {
    return arrays_.isOnBoundary[placeOf(node)] != 0;
  }
  [[nodiscard]] std::vector<std::string> surfaceNames() const override;
  [[nodiscard]] Surface surface(const std::string& name) const override; ///< whole
  [[nodiscard]] std::vector<std::string> groupNames() const override;
  [[nodiscard]] std::vector<GlobalOrdinal> group(const std::string& name) const override; ///< as far as held
  [[nodiscard]] std::vector<std::string> nodeSetNames() const override;
  [[nodiscard]] std::vector<GlobalOrdinal> nodeSet(const std::string& name) const override; ///< whole

private:
  [[nodiscard]] std::size_t placeOf(GlobalOrdinal node) const;
  [[nodiscard]] std::size_t placeOfElement(GlobalOrdinal element) const;

  PartArrays arrays_;
  MeshTopology topology_; ///< of the held elements
};

} // namespace epafi::mesh
