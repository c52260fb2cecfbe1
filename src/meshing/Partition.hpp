#pragma once

/// Partition of one body's elements into subdomains.

#include "epafi/mesh/StructuredMesh.hpp"

#include <array>
#include <memory>
#include <vector>

namespace epafi::meshing {

/// Which part each element belongs to. Parts are numbered from 0 and each is connected through facets of
/// elements.
class Partition {
public:
  virtual ~Partition() = default;
  [[nodiscard]] virtual int numParts() const = 0;                    ///< at least 1
  [[nodiscard]] virtual int partOf(GlobalOrdinal element) const = 0; ///< of an element of the body
  /// Elements of a part, ascending.
  [[nodiscard]] virtual std::vector<GlobalOrdinal> elementsOf(int part) const = 0;
};

/// Cuts a rectangle into counts[0] × counts[1] rectangles, a box into counts[0] × counts[1] × counts[2]
/// boxes, of as equal numbers of elements as possible; parts are numbered x fastest, then y, then z. Stores
/// one number a column and one a row of elements, nothing of the mesh's size.
class GridPartition final : public Partition {
public:
  /// Precondition: 1 ≤ counts ≤ number of elements in each direction; in the plane the third count does not
  /// matter.
  GridPartition(const mesh::StructuredMesh& mesh, std::array<int, 3> counts);
  [[nodiscard]] int numParts() const override { return counts_[0] * counts_[1] * counts_[2]; }
  [[nodiscard]] int partOf(GlobalOrdinal element) const override;
  [[nodiscard]] std::vector<GlobalOrdinal> elementsOf(int part) const override;

private:
  std::array<int, 3> elements_;
  std::array<int, 3> counts_;
  std::vector<int> columnOf_; ///< column of parts of each column of elements
  std::vector<int> rowOf_;    ///< row of parts of each row of elements; rows are counted through all layers
};

/// What each part of a mesh must be.
enum class Parts {
  connected, ///< through facets of elements
  braced     ///< of elements, too, that are braced by others of the part (BracedElements.hpp)
};

/// Cuts the dual graph of a mesh by METIS and makes every part connected. The part of every element of the
/// body is kept on each rank (two ints an element): the one place where something of the mesh's size is
/// replicated.
class GraphPartition final : public Partition {
public:
  /// METIS runs on rank 0, its result is broadcast; the same mesh and count give the same parts on any
  /// number of ranks. The number of parts may differ from the one asked for where METIS leaves parts empty,
  /// and be less where small ones are to be braced.
  /// Collective. \throws InputError if METIS refuses.
  GraphPartition(const mesh::Mesh& mesh, int parts, const Comm& comm, Parts kind = Parts::connected);
  [[nodiscard]] int numParts() const override { return numParts_; }
  [[nodiscard]] int partOf(GlobalOrdinal element) const override { return part_[element]; }
  [[nodiscard]] std::vector<GlobalOrdinal> elementsOf(int part) const override;

private:
  int numParts_ = 0;
  std::vector<int> part_;
  std::vector<std::size_t> start_; ///< of each part in members_
  std::vector<int> members_;       ///< elements, part by part, ascending in each
};

/// Another partition with its parts numbered anew: each run of `size` lies together, as recursive bisection
/// of their centres has it, so that runs can be clusters, and ranks have neighbours.
class GroupedPartition final : public Partition {
public:
  /// \param size  > 0. Passes once over the mesh. Not collective.
  GroupedPartition(std::shared_ptr<const Partition> parts, const mesh::Mesh& mesh, int size);
  [[nodiscard]] int numParts() const override { return parts_->numParts(); }
  [[nodiscard]] int partOf(GlobalOrdinal element) const override { return number_[parts_->partOf(element)]; }
  [[nodiscard]] std::vector<GlobalOrdinal> elementsOf(int part) const override {
    return parts_->elementsOf(order_[part]);
  }

private:
  std::shared_ptr<const Partition> parts_;
  std::vector<int> order_, number_; ///< old numbers of the parts, and new ones
};

/// Cuts a mesh that need not hang together, on one rank: each piece by METIS, into its share of the parts,
/// one at least. Not collective. \throws InputError if METIS refuses.
std::unique_ptr<const Partition> cutPieces(const mesh::Mesh& mesh, int parts, Parts kind = Parts::connected);

/// Elements that a rank holds, and their parts.
struct HeldElements {
  int begin = 0, end = 0;              ///< the rank's own parts
  std::vector<GlobalOrdinal> elements; ///< ascending: all those of the own parts, and others
  std::vector<int> parts;              ///< of each
};

/// What one rank knows of a partition.
class HeldPartition final : public Partition {
public:
  HeldPartition(int numParts, HeldElements held); ///< numParts: of the whole body
  [[nodiscard]] int numParts() const override { return numParts_; }
  [[nodiscard]] int partOf(GlobalOrdinal element) const override;               ///< of a held one
  [[nodiscard]] std::vector<GlobalOrdinal> elementsOf(int part) const override; ///< of an own one

private:
  int numParts_;
  HeldElements held_;
  std::vector<std::vector<GlobalOrdinal>> own_; ///< elements of each own part
};

/// Makes every part of a mesh connected through facets of elements (edges in 2-D, faces in 3-D): each piece
/// that is not the largest of its part goes to the neighbouring part with which it shares most facets. Parts
/// may become empty. Where the mesh itself has pieces, these remain as they are.
///
/// \param[in,out] part  of every element, ≥ 0
void makeConnected(const mesh::Mesh& mesh, std::vector<int>& part);

} // namespace epafi::meshing
