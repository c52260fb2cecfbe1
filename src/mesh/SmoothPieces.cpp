#include "epafi/mesh/SmoothPieces.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <sstream>

namespace epafi::mesh {
namespace {

using Eigen::Vector3d;

/// Where a facet ends, and the next one begins: an edge, in the plane a node.
struct Ridge {
  std::array<GlobalOrdinal, 2> ends; ///< ascending
  std::size_t facet;
  Vector3d normal; ///< of the facet there, of length 1

  bool operator<(const Ridge& other) const { return ends < other.ends; }
};

std::vector<Point> pointsOf(const Surface& surface, std::size_t facet, const PointAt& pointAt) {
  std::vector<Point> points;
  for (const GlobalOrdinal node : surface.facet(facet))
    points.push_back(pointAt(node));
  return points;
}

/// All of them, those with the same ends side by side.
std::vector<Ridge> ridgesOf(const Surface& surface, const PointAt& pointAt) {
  std::vector<Ridge> ridges;
  std::vector<Vector3d> normals;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto corners = surface.corners(f);
    const std::vector<Point> points = pointsOf(surface, f, pointAt);
    normals.resize(points.size());
    nodalNormals(surface.typeOf(f), points, normals);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const std::size_t next = corners.size() == 2 ? c : (c + 1) % corners.size();
      const auto [least, most] = std::minmax(corners[c], corners[next]);
      ridges.push_back({{least, most}, f, (normals[c] + normals[next]).normalized()});
    }
  }
  std::sort(ridges.begin(), ridges.end());
  return ridges;
}

Vector3d asVector(const Point& point) {
  return {point[0], point[1], point[2]};
}

double distanceToSegment(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double share = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (x - a - share * along).norm();
}

double distanceToTriangle(const Vector3d& x, const std::array<Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vector3d normal = (b - a).cross(c - a);
  const auto isInside = [&](const Vector3d& from, const Vector3d& to) {
    return (to - from).cross(x - from).dot(normal) >= 0;
  };
  if (isInside(a, b) && isInside(b, c) && isInside(c, a))
    return std::abs((x - a).dot(normal.normalized()));
  return std::min({distanceToSegment(x, a, b), distanceToSegment(x, b, c), distanceToSegment(x, c, a)});
}

} // namespace

std::string wordsOfPlace(const Point& place, int dimension) {
  std::string words = "at";
  for (std::size_t d = 0; d < index(dimension); ++d)
    words += ' ' + text(place[d]);
  return words;
}

std::optional<Point> placeIn(const std::string& words) {
  std::istringstream stream(words);
  std::string word;
  if (!(stream >> word) || word != "at")
    return std::nullopt;
  Point place{};
  std::size_t count = 0;
  try {
    for (; stream >> word; ++count)
      place.at(count) = parsedReal(word);
  } catch (const std::exception&) { // no number, or the fourth
    return std::nullopt;
  }
  return count < 2 ? std::nullopt : std::optional(place);
}

std::vector<std::vector<std::size_t>> smoothPieces(const Surface& boundary, const PointAt& pointAt) {
  constexpr double sharpest = 0.76604444311897804;      // cosine of 40 degrees
  std::vector<std::size_t> first(boundary.numFacets()); // facets on the way to the first one of the piece
  std::iota(first.begin(), first.end(), std::size_t{0});
  const auto firstOf = [&](std::size_t facet) {
    while (first[facet] != facet)
      facet = first[facet] = first[first[facet]];
    return facet;
  };
  const std::vector<Ridge> ridges = ridgesOf(boundary, pointAt);
  for (std::size_t r = 0; r < ridges.size(); ++r)
    for (std::size_t s = r + 1; s < ridges.size() && ridges[s].ends == ridges[r].ends; ++s)
      if (ridges[r].normal.dot(ridges[s].normal) >= sharpest) {
        const std::size_t a = firstOf(ridges[r].facet), b = firstOf(ridges[s].facet);
        first[std::max(a, b)] = std::min(a, b);
      }
  std::vector<std::vector<std::size_t>> pieces;
  std::vector<std::size_t> pieceOf(first.size());
  for (std::size_t f = 0; f < first.size(); ++f) {
    if (firstOf(f) == f) {
      pieceOf[f] = pieces.size();
      pieces.emplace_back();
    }
    pieces[pieceOf[firstOf(f)]].push_back(f);
  }
  return pieces;
}

std::size_t nearestFacet(const Surface& surface, const PointAt& pointAt, const Point& place) {
  const Vector3d x = asVector(place);
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    std::vector<Vector3d> corners;
    for (const GlobalOrdinal node : surface.corners(f))
      corners.push_back(asVector(pointAt(node)));
    double distance = distanceToSegment(x, corners[0], corners[1]);
    for (std::size_t c = 2; c < corners.size(); ++c)
      distance = std::min(distance, distanceToTriangle(x, {corners[0], corners[c - 1], corners[c]}));
    if (distance < least) {
      least = distance;
      nearest = f;
    }
  }
  return nearest;
}

} // namespace epafi::mesh
