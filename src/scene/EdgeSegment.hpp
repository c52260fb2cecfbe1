#pragma once

/// Edges of rectangles as segments, and when two of them are the same.

#include "epafi/scene/Scene.hpp"

#include <string>

namespace epafi::scene {

/// An edge runs from `from` to `to` at the distance `at` from the axis that it is parallel to.
struct EdgeSegment {
  bool isVertical = true;
  double at = 0, from = 0, to = 0;
};

EdgeSegment segmentOf(const Rectangle& box, Edge edge);

/// "x = 1, y from 0 to 1", with as many digits as tell numbers apart.
std::string toString(const EdgeSegment& segment);

/// Whether the edges are the same up to 1e-10 of the shorter one's length, far more than round-off of their
/// ends. Cut into the same number of elements they have the same nodes then.
bool coincide(const EdgeSegment& a, const EdgeSegment& b);

} // namespace epafi::scene
