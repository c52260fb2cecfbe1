#pragma once

/// Which ranks have a node, and what is known of it, where no rank has all nodes: each is kept by the rank
/// that its key tells, equal ranges of keys by each.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <array>
#include <map>
#include <vector>

namespace epafi::meshing {

class NodeDirectory {
public:
  /// A node as a rank hands it in.
  struct Node {
    GlobalOrdinal key = 0; ///< ≥ 0, the same on all ranks; there may be gaps
    Point point{};
    bool isCorner = false; ///< of the element that brings it
  };
  /// What is known of one.
  struct Entry {
    GlobalOrdinal number = 0;  ///< from 0, in the order of the keys
    GlobalOrdinal corner = -1; ///< its number among the corners; −1: it is none
    Point point{};
    bool isOnBoundary = false;
  };

  /// Takes in and numbers the nodes that the ranks have, each as often as it comes. Keeps the reference.
  /// Collective. \throws InputError, the same on all ranks, if one lies at two places.
  NodeDirectory(const Comm& comm, std::vector<Node> nodes);

  [[nodiscard]] GlobalOrdinal numNodes() const { return numNodes_; }
  [[nodiscard]] GlobalOrdinal numCorners() const { return numCorners_; }
  [[nodiscard]] const std::array<Point, 2>& box() const { return box_; } ///< of all nodes

  /// Of the other ranks that ask for some of the same nodes, these, ascending. \param keys ascending, none
  /// twice. Collective.
  [[nodiscard]] std::map<int, std::vector<GlobalOrdinal>>
  shared(const std::vector<GlobalOrdinal>& keys) const;
  /// Notes that nodes lie on the body's boundary. \param keys  ascending. Collective.
  void markBoundary(const std::vector<GlobalOrdinal>& keys);
  /// What is known of some nodes. \param keys  ascending. Collective.
  [[nodiscard]] std::vector<Entry> find(const std::vector<GlobalOrdinal>& keys) const;

private:
  using Keys = std::map<int, std::vector<GlobalOrdinal>>; ///< by rank
  [[nodiscard]] int homeOf(GlobalOrdinal key) const {
    return static_cast<int>((key - firstKey_) / keysEach_);
  }
  [[nodiscard]] Keys byHome(const std::vector<GlobalOrdinal>& keys) const;
  [[nodiscard]] std::size_t placeOf(GlobalOrdinal key) const;
  void keep(std::vector<Node> nodes);
  void number();

  const Comm& comm_;
  GlobalOrdinal firstKey_ = 0;      ///< of all nodes
  GlobalOrdinal keysEach_ = 1;      ///< a rank keeps as many keys in turn
  std::vector<GlobalOrdinal> keys_; ///< of the kept nodes, ascending
  std::vector<Entry> entries_;      ///< likewise
  GlobalOrdinal numNodes_ = 0, numCorners_ = 0;
  std::array<Point, 2> box_{};
};

} // namespace epafi::meshing
