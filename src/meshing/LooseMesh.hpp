#pragma once

/// The elements of a body before they are dealt out: each on the rank that read it.

#include "epafi/mesh/Cell.hpp"
#include "epafi/meshing/NodeDirectory.hpp"
#include "epafi/meshing/Partition.hpp"

#include <array>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace epafi::meshing {

/// Elements as they travel between ranks: of each its number in the body, its part, the groups that it is in,
/// and its nodes.
class LooseElements {
public:
  /// \param numNodes  length of the rows (Cell.hpp) that nodes stand in
  LooseElements(std::size_t numGroups, std::size_t numNodes);

  /// Of the same form, without elements.
  [[nodiscard]] LooseElements none() const;
  void reserve(std::size_t number) { values_.reserve(number * width_); } ///< of elements
  /// Of no group yet. \param nodes  their keys, perhaps in a shorter row
  void add(GlobalOrdinal number, int part, std::span<const GlobalOrdinal> nodes);
  void setIn(std::size_t place, std::size_t group); ///< the element at a place is in a group
  [[nodiscard]] std::size_t size() const { return values_.size() / width_; }
  [[nodiscard]] GlobalOrdinal number(std::size_t place) const { return values_[place * width_]; }
  [[nodiscard]] int part(std::size_t place) const { return static_cast<int>(values_[place * width_ + 1]); }
  [[nodiscard]] bool isIn(std::size_t place, std::size_t group) const;
  [[nodiscard]] std::span<const GlobalOrdinal> nodes(std::size_t place) const {
    return record(place).subspan(nodesAt_);
  }

  /// All of one element, to send.
  [[nodiscard]] std::span<const GlobalOrdinal> record(std::size_t place) const {
    return std::span(values_).subspan(place * width_, width_);
  }
  /// Takes in what records hold, one after the other.
  void append(std::span<const GlobalOrdinal> records);
  /// By their numbers, none twice.
  void sort();

private:
  std::size_t nodesAt_, width_; ///< where the nodes stand in a record, and its length
  std::vector<GlobalOrdinal> values_;
};

/// A facet of a named surface: keys of its corners, those that it lacks −1; or a node of a named set, with
/// one corner alone.
struct NamedFacet {
  int surface = 0; ///< place of its name
  std::array<GlobalOrdinal, mesh::mostFacetCorners> corners{};
};

/// Facets and the names of the surfaces that they belong to.
struct FacetList {
  std::vector<std::string> names;
  std::vector<NamedFacet> facets;

  /// \param corners  their keys
  void add(const std::string& surface, std::span<const GlobalOrdinal> corners);
};

/// Those of all ranks, on all ranks, names in alphabetical order and none twice. Collective.
FacetList gathered(const FacetList& own, const Comm& comm);

/// The names of all ranks, in alphabetical order, none twice. Collective.
std::vector<std::string> allNames(const std::set<std::string>& own, const Comm& comm);

struct LooseMesh {
  mesh::CellType cellType = mesh::CellType::triangle; ///< of the largest elements, the same on all ranks
  int numParts = 0;                                   ///< of the whole body, on all ranks
  std::vector<std::string> groups;                    ///< names, the same on all ranks

  LooseElements elements{0, 3};           ///< this rank's; no element is on two
  std::vector<NodeDirectory::Node> nodes; ///< of these elements, each once or more often
  /// Of all ranks, each once or more often; there may be some of other bodies.
  std::shared_ptr<const FacetList> facets;
};

/// What one rank has of a body: all of it or a file's share, and the way it is cut.
struct MeshShare {
  const mesh::Mesh* mesh;
  const Partition* partition;
  /// What the body's other shares call a node, too.
  std::function<GlobalOrdinal(GlobalOrdinal node)> keyOf;
};

/// Numbers elements and parts through all shares of all ranks, in this order. \param facets of named
/// surfaces; see gathered() Precondition: some rank has elements. Collective. \throws InputError, the same on
/// all ranks, if they are not of one order and dimension.
LooseMesh looseMeshOf(std::span<const MeshShare> shares, std::shared_ptr<const FacetList> facets,
                      const Comm& comm);

} // namespace epafi::meshing
