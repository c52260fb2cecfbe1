#pragma once

/// Mesh of any elements of one dimension and order, held as arrays: about 140 bytes a hexahedron or 70 a
/// tetrahedron, all told.

#include "epafi/mesh/MeshArrays.hpp"
#include "epafi/mesh/MeshTopology.hpp"

#include <cstdint>

namespace epafi::mesh {

class UnstructuredMesh final : public Mesh {
public:
  /// Throws InputError if the mesh is not sound (see checkMesh()), or a facet of a named surface is none of
  /// the mesh's boundary or listed twice in it. Every error that the mesh can give, it gives here. O(n log
  /// n), local.
  explicit UnstructuredMesh(MeshArrays arrays);

  [[nodiscard]] CellType cellType() const override { return arrays_.cellType; }
  [[nodiscard]] GlobalOrdinal numNodes() const override { return arrays_.points.size(); }
  [[nodiscard]] GlobalOrdinal numElements() const override { return arrays_.numElements(); }
  [[nodiscard]] Point point(GlobalOrdinal node) const override { return arrays_.points[node]; }
  void elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const override;
  void elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const override;
  /// Ascending.
  void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const override;
  void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const override;
  /// In the order of the element's facets.
  void elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const override;
  [[nodiscard]] bool isBoundaryNode(GlobalOrdinal node) const override {
    return topology_.isOnBoundary(node);
  }

  [[nodiscard]] std::vector<std::string> surfaceNames() const override;
  /// Facets by ascending element.
  [[nodiscard]] Surface surface(const std::string& name) const override;
  /// All facets of the boundary, likewise.
  [[nodiscard]] Surface boundary() const;
  /// Names the smooth piece of the boundary (SmoothPieces.hpp) that is nearest to the place in these words,
  /// unless a surface has the name. Precondition: they name a place.
  void namePiece(const std::string& words);
  [[nodiscard]] std::vector<std::string> groupNames() const override;
  [[nodiscard]] std::vector<GlobalOrdinal> group(const std::string& name) const override;
  [[nodiscard]] std::vector<std::string> nodeSetNames() const override;
  [[nodiscard]] std::vector<GlobalOrdinal> nodeSet(const std::string& name) const override;

  /// How errors call the body.
  [[nodiscard]] const std::string& name() const { return arrays_.name; }
  /// Numbers that a node and an element have in the file.
  [[nodiscard]] GlobalOrdinal nodeTag(GlobalOrdinal node) const { return arrays_.nodeTags[node]; }
  [[nodiscard]] GlobalOrdinal elementTag(GlobalOrdinal element) const { return arrays_.elementTags[element]; }

private:
  /// A facet by its element and its place in facetsOf().
  struct FacetPlace {
    LocalOrdinal element;
    std::uint8_t place;

    bool operator==(const FacetPlace& other) const = default;
    bool operator<(const FacetPlace& other) const {
      return element != other.element ? element < other.element : place < other.place;
    }
  };

  void findFacets(const NamedFacets& surface);
  [[nodiscard]] std::vector<FacetPlace> boundaryFacets() const;
  [[nodiscard]] Surface surfaceOf(const std::vector<FacetPlace>& facets) const;
  [[nodiscard]] FacetPlace findFacet(const std::string& surface, std::span<const LocalOrdinal> nodes) const;

  MeshArrays arrays_; ///< without the surfaces' nodes
  MeshTopology topology_;
  std::vector<std::vector<FacetPlace>> facets_; ///< of each surface, ascending
};

} // namespace epafi::mesh
