#pragma once

/// Boxes in a tree, to find those that meet a box without looking at the others.

#include "epafi/fem/Mesh.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace epafi::contact {

/// An R-tree (Boost.Geometry), packed: 𝒪(n log n) to make, 𝒪(log n) for a box that meets few.
class FacetTree {
public:
  using Box = std::array<fem::Point, 2>; ///< lowest and highest coordinates

  explicit FacetTree(std::span<const Box> boxes);
  FacetTree(const FacetTree&) = delete;
  FacetTree& operator=(const FacetTree&) = delete;
  FacetTree(FacetTree&&) = delete;
  FacetTree& operator=(FacetTree&&) = delete;
  ~FacetTree();

  /// Numbers of the boxes that meet a closed one, ascending; `found` is overwritten.
  void meeting(const Box& box, std::vector<std::size_t>& found) const;

private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

} // namespace epafi::contact
