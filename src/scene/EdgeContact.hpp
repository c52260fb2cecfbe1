#pragma once

/// Contact of membranes on rectangles: along edges that coincide node by node.

#include "epafi/scene/Scene.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace epafi::scene {

/// The edges of rectangles, by which their surfaces are called.
constexpr std::array<const char*, 4> edges{"left", "right", "bottom", "top"};

/// An edge runs from `from` to `to` at the distance `at` from the axis that it is parallel to.
struct EdgeSegment {
  bool isVertical = true;
  double at = 0, from = 0, to = 0;
};

EdgeSegment segmentOf(const mesh::Box& rectangle, const std::string& edge);

/// "x = 1, y from 0 to 1", with as many digits as tell numbers apart.
std::string toString(const EdgeSegment& segment);

/// Whether the edges are the same up to 1e-10 of the shorter one's length, far more than round-off of their
/// ends. Cut into the same number of elements they have the same nodes then.
bool coincide(const EdgeSegment& a, const EdgeSegment& b);

/// Whether both bodies are membranes on rectangles.
bool isAlongEdges(const Scene& scene, const SurfaceContact& contact);

/// What is wrong with such a contact.
struct EdgeFault {
  int side = -1;         ///< 0: its first edge, 1: its second, −1: both together
  std::string objection; ///< a sentence that begins behind "but", or, of both, behind the contact's name
};

/// An edge that is supported or in a contact before this one, two that do not coincide or have different
/// numbers of elements. Precondition: isAlongEdges().
std::optional<EdgeFault> faultOf(const Scene& scene, std::size_t contact);

} // namespace epafi::scene
