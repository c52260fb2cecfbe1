#include "epafi/contact/SmoothSurface.hpp"

#include "epafi/mesh/Cell.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;

/// A surface with facets, and its nodes.
struct Facets {
  mesh::Surface surface;
  std::vector<Vector3d> points;

  explicit Facets(mesh::CellType type) { surface.facetType = type; }
  void add(std::initializer_list<std::size_t> nodes) {
    for (const std::size_t node : nodes)
      surface.facetNodes.push_back(node);
    surface.elements.push_back(0);
  }
  [[nodiscard]] SmoothSurface smooth() const {
    return {[this](GlobalOrdinal node) {
              const Vector3d& x = points[node];
              return Point{x[0], x[1], x[2]};
            },
            surface};
  }
};

class Random {
public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// Between −size and size.
  double operator()(double size) { return std::uniform_real_distribution<double>(-size, size)(engine_); }

private:
  std::mt19937 engine_;
};

/// `number` edges around a circle of radius 1, each turned by up to `unevenness` of their angle; all but
/// `open` of them.
Facets polygon(int number, double unevenness, unsigned seed, int open = 0) {
  Facets facets(mesh::CellType::line);
  Random random(seed);
  for (int i = 0; i < number; ++i) {
    const double angle = 2 * std::numbers::pi / number * (i + random(unevenness));
    facets.points.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  for (int i = 0; i < number - open; ++i)
    facets.add({static_cast<std::size_t>(i), static_cast<std::size_t>((i + 1) % number)});
  return facets;
}

/// A cylinder about z with `number` nodes around and triangles about as high as long; nodes are off their
/// even places.
Facets cylinder(int number, double unevenness, unsigned seed) {
  Facets facets(mesh::CellType::triangle);
  Random random(seed);
  const std::size_t n = number;
  constexpr std::size_t numRings = 5;
  const double size = 2 * std::numbers::pi / number;
  for (std::size_t ring = 0; ring < numRings; ++ring)
    for (std::size_t i = 0; i < n; ++i) {
      const double angle =
          size * (static_cast<double>(i) + 0.5 * static_cast<double>(ring % 2) + random(unevenness));
      const bool isRim = ring == 0 || ring + 1 == numRings;
      facets.points.emplace_back(std::cos(angle), std::sin(angle),
                                 size * (static_cast<double>(ring) + (isRim ? 0 : random(0.7 * unevenness))));
    }
  for (std::size_t ring = 0; ring + 1 < numRings; ++ring)
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t a = ring * n + i, b = ring * n + (i + 1) % n, c = a + n, d = b + n;
      if (ring % 2 == 0) {
        facets.add({a, b, c});
        facets.add({b, d, c});
      } else {
        facets.add({a, b, d});
        facets.add({a, d, c});
      }
    }
  return facets;
}

/// An icosahedron on the unit sphere, each triangle cut into four `level` times, with nodes off their even
/// places.
Facets sphere(int level, double unevenness, unsigned seed) {
  const double g = std::numbers::phi;
  Facets facets(mesh::CellType::triangle);
  for (const auto& [x, y, z] : std::vector<std::array<double, 3>>{{-1, g, 0},
                                                                  {1, g, 0},
                                                                  {-1, -g, 0},
                                                                  {1, -g, 0},
                                                                  {0, -1, g},
                                                                  {0, 1, g},
                                                                  {0, -1, -g},
                                                                  {0, 1, -g},
                                                                  {g, 0, -1},
                                                                  {g, 0, 1},
                                                                  {-g, 0, -1},
                                                                  {-g, 0, 1}})
    facets.points.push_back(Vector3d(x, y, z).normalized());
  std::vector<std::array<std::size_t, 3>> triangles{
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
    const auto middle = [&](std::size_t a, std::size_t b) {
      const auto [found, isNew] = middles.try_emplace(std::minmax(a, b), facets.points.size());
      if (isNew)
        facets.points.push_back((facets.points[a] + facets.points[b]).normalized());
      return found->second;
    };
    std::vector<std::array<std::size_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  Random random(seed);
  const double off = unevenness * 1.1 / std::pow(2, level);
  for (Vector3d& x : facets.points)
    x = (x + Vector3d(random(off), random(off), random(off))).normalized();
  for (const auto& [a, b, c] : triangles)
    facets.add({a, b, c});
  return facets;
}

/// The same with nodes between the corners, on the middle of the edges or moved from there to where they
/// belong.
Facets quadratic(const Facets& linear, const std::function<Vector3d(const Vector3d&)>& moved) {
  Facets facets(withOrder(linear.surface.facetType, 2));
  facets.points = linear.points;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
  for (std::size_t f = 0; f < linear.surface.numFacets(); ++f) {
    std::vector<std::size_t> nodes;
    for (const GlobalOrdinal corner : linear.surface.facet(f))
      nodes.push_back(corner);
    const auto edges = edgesOf(linear.surface.facetType);
    const std::vector<std::size_t> corners = nodes;
    for (std::size_t e = 0; e < edges.size(); e += 2) {
      const std::size_t a = corners[edges[e]], b = corners[edges[e + 1]];
      const auto [found, isNew] = middles.try_emplace(std::minmax(a, b), facets.points.size());
      if (isNew)
        facets.points.push_back(moved((facets.points[a] + facets.points[b]) / 2));
      nodes.push_back(found->second);
    }
    for (const std::size_t node : nodes)
      facets.surface.facetNodes.push_back(node);
    facets.surface.elements.push_back(0);
  }
  return facets;
}

Vector3d acrossCylinder(const Vector3d& x) {
  return Vector3d(x[0], x[1], 0).normalized();
}

/// Largest angle of the normals with the true ones beside what they say of themselves, and the largest that
/// they say.
std::pair<double, double> worst(const Facets& facets, const std::function<Vector3d(const Vector3d&)>& truth) {
  const SmoothSurface smooth = facets.smooth();
  double ratio = 0, largest = 0;
  for (const GlobalOrdinal node : facets.surface.facetNodes) {
    const auto& normal = smooth.at(node);
    EXPECT_TRUE(normal.has_value()) << node;
    if (!normal)
      continue;
    const Vector3d right = truth(facets.points[node]);
    const double angle = std::atan2(right.cross(normal->direction).norm(), right.dot(normal->direction));
    ratio = std::max(ratio, angle / (normal->uncertainty + 1e-12));
    largest = std::max(largest, normal->uncertainty);
  }
  return {ratio, largest};
}

TEST(SmoothSurfaceTest, KnowsNormalsOfCirclesBetterThanItSays) {
  for (const int number : {8, 12, 24, 100})
    for (unsigned seed = 0; seed < 5; ++seed) {
      const auto [ratio, largest] = worst(polygon(number, 0.1, seed), acrossCylinder);
      EXPECT_LE(ratio, 1) << number;
      EXPECT_LE(largest, std::pow(1.2 * std::numbers::pi / number, 3) / 4) << number;
    }
}

TEST(SmoothSurfaceTest, KnowsLessAtEndsOfArcs) {
  const auto [ratio, largest] = worst(polygon(24, 0.3, 1, 6), acrossCylinder);
  EXPECT_LE(ratio, 1);
  EXPECT_LE(largest, 1.6 * std::numbers::pi / 24);
}

TEST(SmoothSurfaceTest, KnowsNormalsOfCylindersAndSpheresBetterThanItSays) {
  const auto outwards = [](const Vector3d& x) -> Vector3d { return x.normalized(); };
  for (unsigned seed = 0; seed < 5; ++seed) {
    for (const int number : {12, 24, 60})
      EXPECT_LE(worst(cylinder(number, 0.2, seed), acrossCylinder).first, 1) << number;
    for (const int level : {1, 2, 3})
      EXPECT_LE(worst(sphere(level, 0.1, seed), outwards).first, 1) << level;
  }
}

TEST(SmoothSurfaceTest, KnowsThemFromFacetsOfOrderTwoWhetherCurvedOrNot) {
  const auto onCylinder = [](const Vector3d& x) {
    return Vector3d(Vector3d(x[0], x[1], 0).normalized() + Vector3d(0, 0, x[2]));
  };
  const auto inPlace = [](const Vector3d& x) { return x; };
  for (unsigned seed = 0; seed < 5; ++seed) {
    for (const auto& between : {std::function<Vector3d(const Vector3d&)>(onCylinder),
                                std::function<Vector3d(const Vector3d&)>(inPlace)}) {
      EXPECT_LE(worst(quadratic(cylinder(24, 0.2, seed), between), acrossCylinder).first, 1);
      EXPECT_LE(worst(quadratic(polygon(24, 0.2, seed), between), acrossCylinder).first, 1);
    }
    EXPECT_LE(worst(quadratic(cylinder(12, 0.2, seed), onCylinder), acrossCylinder).second, 0.1);
  }
}

TEST(SmoothSurfaceTest, IsSureOfPlanes) {
  Facets plane = cylinder(8, 0.2, 1);
  for (Vector3d& x : plane.points) // about an axis in it: the lower ring is the inner one
    x = Vector3d(x[0] * (5 - x[2]), x[1] * (5 - x[2]), 0);
  const auto [ratio, largest] = worst(plane, [](const Vector3d&) { return Vector3d(0, 0, 1); });
  EXPECT_LE(largest, 1e-7);
  EXPECT_LE(ratio, 1);
}

TEST(SmoothSurfaceTest, TakesSharpBendsForEdges) {
  const auto isEdge = [](const Facets& facets) { return !facets.smooth().at(0).has_value(); };
  EXPECT_TRUE(isEdge(polygon(4, 0, 0)));
  EXPECT_TRUE(isEdge(polygon(6, 0, 0)));
  EXPECT_FALSE(isEdge(polygon(7, 0, 0)));
  EXPECT_TRUE(isEdge(sphere(0, 0, 0)));
  EXPECT_FALSE(isEdge(sphere(1, 0, 0)));
}

} // namespace
} // namespace epafi::contact
