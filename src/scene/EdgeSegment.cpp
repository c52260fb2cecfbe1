#include "epafi/scene/EdgeSegment.hpp"

#include "epafi/base/ParameterValue.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::scene {

EdgeSegment segmentOf(const Rectangle& box, Edge edge) {
  if (edge == Edge::left || edge == Edge::right)
    return {true, edge == Edge::left ? box.x0 : box.x1, box.y0, box.y1};
  return {false, edge == Edge::bottom ? box.y0 : box.y1, box.x0, box.x1};
}

std::string toString(const EdgeSegment& segment) {
  const std::string along = valueText(segment.from) + " to " + valueText(segment.to);
  return (segment.isVertical ? "x = " : "y = ") + valueText(segment.at) + ", " +
         (segment.isVertical ? "y" : "x") + " from " + along;
}

bool coincide(const EdgeSegment& a, const EdgeSegment& b) {
  const double tolerance = 1e-10 * std::min(a.to - a.from, b.to - b.from);
  const auto isNear = [tolerance](double x, double y) { return std::abs(x - y) <= tolerance; };
  return a.isVertical == b.isVertical && isNear(a.at, b.at) && isNear(a.from, b.from) && isNear(a.to, b.to);
}

} // namespace epafi::scene
