#include "epafi/accuracy/FirstGrid.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::accuracy {
namespace {

/// Where the body itself needs lines across an axis.
std::vector<double> ownLines(const scene::Body& body, std::size_t axis) {
  std::vector<double> lines{body.mesh.box.lower[axis], body.mesh.box.upper[axis]};
  const auto add = [&](const mesh::Box& box) {
    lines.push_back(box.lower[axis]);
    lines.push_back(box.upper[axis]);
  };
  for (const fem::SolidRegion& region : body.regions)
    add(region.box);
  for (const fem::SolidLoad& load : body.loads) {
    if (load.kind == fem::SolidLoad::Kind::body)
      add(load.box);
    else if (load.kind == fem::SolidLoad::Kind::point)
      lines.push_back(load.point[axis]);
  }
  return lines;
}

double longestElement(const scene::Body& body, std::size_t axis) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < index(dimensionOf(body.physics)); ++d)
    least = std::min(least, body.mesh.box.upper[d] - body.mesh.box.lower[d]);
  return std::max(0.5 * least,
                  (body.mesh.box.upper[axis] - body.mesh.box.lower[axis]) / body.mesh.elements[axis]);
}

/// The body, and those on grids that it touches.
std::vector<const scene::Body*> together(const scene::Scene& scene, std::size_t body) {
  std::vector<const scene::Body*> bodies{&scene.bodies[body]};
  for (const scene::SurfaceContact& contact : scene.contacts) {
    const int other = index(contact.first) == body    ? contact.second
                      : index(contact.second) == body ? contact.first
                                                      : -1;
    if (other >= 0 && scene.bodies[index(other)].mesh.file.empty())
      bodies.push_back(&scene.bodies[index(other)]);
  }
  return bodies;
}

/// Coordinates of all lines across an axis, ascending.
std::vector<double> linesAcross(const scene::Scene& scene, std::size_t number, std::size_t axis) {
  const scene::Body& body = scene.bodies[number];
  const double lower = body.mesh.box.lower[axis], upper = body.mesh.box.upper[axis];
  const double least = 1e-6 * (upper - lower); // lines nearer than that are one
  const std::vector<const scene::Body*> bodies = together(scene, number);
  std::vector<double> needed{lower, upper};
  for (const scene::Body* other : bodies)
    for (const double line : ownLines(*other, axis))
      if (line > lower + least && line < upper - least)
        needed.push_back(line);
  std::sort(needed.begin(), needed.end());
  needed.erase(std::unique(needed.begin(), needed.end(), [&](double a, double b) { return b - a < least; }),
               needed.end());
  needed.back() = upper;
  std::vector<double> lines{lower};
  for (std::size_t i = 1; i < needed.size(); ++i) {
    const double from = needed[i - 1], to = needed[i];
    double longest = to - from;
    for (const scene::Body* other : bodies)
      if (other->mesh.box.lower[axis] < to - least && other->mesh.box.upper[axis] > from + least)
        longest = std::min(longest, longestElement(*other, axis));
    constexpr double roundOff = 1e-9;
    const auto count = std::max(1, static_cast<int>(std::ceil((to - from) / longest - roundOff)));
    for (int k = 1; k <= count; ++k)
      lines.push_back(k == count ? to : from + (to - from) * k / count);
  }
  return lines;
}

} // namespace

mesh::SimplexMesh firstGrid(const scene::Scene& scene, std::size_t body) {
  std::array<std::vector<double>, 3> lines{};
  std::array<int, 3> counts{0, 0, 0};
  mesh::Box places{{0, 0, 0}, {1, 1, 1}}; // of a line: its number
  for (std::size_t d = 0; d < index(dimensionOf(scene.bodies[body].physics)); ++d) {
    lines[d] = linesAcross(scene, body, d);
    counts[d] = static_cast<int>(lines[d].size()) - 1;
    places.upper[d] = counts[d];
  }
  mesh::SimplexMesh mesh = simplicesOf(mesh::StructuredMesh(places, counts));
  mesh.name = "Body '" + scene.bodies[body].name + "'";
  for (Point& point : mesh.points)
    for (std::size_t d = 0; d < 3; ++d)
      if (!lines[d].empty())
        point[d] = lines[d][std::lround(point[d])];
  return mesh;
}

} // namespace epafi::accuracy
