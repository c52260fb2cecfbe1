#pragma once

/// Boxes or points in a tree, to find those that meet a box, or the nearest, without looking at the others.

#include "epafi/mesh/Mesh.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace epafi::mesh {

/// An R-tree (Boost.Geometry), packed: 𝒪(n log n) to make, 𝒪(log n) for a box that meets few.
class BoxTree {
public:
  using Box = std::array<Point, 2>; ///< lowest and highest coordinates

  explicit BoxTree(std::span<const Box> boxes);
  explicit BoxTree(std::span<const Point> points); ///< a box each
  BoxTree(const BoxTree&) = delete;
  BoxTree& operator=(const BoxTree&) = delete;
  BoxTree(BoxTree&&) = delete;
  BoxTree& operator=(BoxTree&&) = delete;
  ~BoxTree();

  /// Numbers of the boxes that meet a closed one, ascending; `found` is overwritten.
  void meeting(const Box& box, std::vector<std::size_t>& found) const;
  /// Numbers of the boxes nearest to a point, ascending; `found` is overwritten. \param most  how many
  void nearest(const Point& point, std::size_t most, std::vector<std::size_t>& found) const;

private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

} // namespace epafi::mesh
