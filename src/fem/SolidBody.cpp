#include "epafi/fem/SolidBody.hpp"

#include "epafi/fem/BoxMesh.hpp"
#include "epafi/fem/RectangleMesh.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <sstream>
#include <utility>

namespace epafi::fem {
namespace {

std::string listOf(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names)
    all += (all.empty() ? "'" : ", '") + name + "'";
  return all.empty() ? "none" : all;
}

} // namespace

std::vector<Point> congruentCorners(const Mesh& mesh) {
  if (const auto* plane = dynamic_cast<const RectangleMesh*>(&mesh)) {
    const scene::Rectangle& r = plane->rectangle();
    const double a = (r.x1 - r.x0) / plane->elements()[0], b = (r.y1 - r.y0) / plane->elements()[1];
    return {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}};
  }
  if (const auto* box = dynamic_cast<const BoxMesh*>(&mesh)) {
    const auto [a, b, c] = box->elementSize();
    return {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}, {0, 0, c}, {a, 0, c}, {a, b, c}, {0, b, c}};
  }
  return {};
}

SolidBody::SolidBody(std::string bodyName, const scene::Solid& bodySolid, const Mesh& bodyMesh)
    : name(std::move(bodyName)), solid(bodySolid), mesh(bodyMesh), shape(congruentCorners(bodyMesh)) {}

void SolidBody::cornersOf(GlobalOrdinal element, std::vector<Point>& points) const {
  if (isCongruent())
    points = shape;
  else
    pointsOf(element, points);
}

std::string text(const Point& point) {
  std::ostringstream result;
  result << '(' << point[0] << ", " << point[1] << ", " << point[2] << ')';
  return result.str();
}

InputError SolidBody::refusal(const std::string& what) const {
  return InputError("body '" + name + "': " + what);
}

Surface SolidBody::surfaceOf(const std::string& user, const std::string& surface) const {
  const std::vector<std::string> names = mesh.surfaceNames();
  if (std::find(names.begin(), names.end(), surface) == names.end())
    throw refusal(user + " names the surface '" + surface + "', which its mesh does not have; it has " +
                  listOf(names));
  return mesh.surface(surface);
}

std::vector<GlobalOrdinal> SolidBody::groupOf(const std::string& user, const std::string& group) const {
  const std::vector<std::string> names = mesh.groupNames();
  if (std::find(names.begin(), names.end(), group) == names.end())
    throw refusal(user + " names the group '" + group + "', which its mesh does not have; it has " +
                  listOf(names));
  return mesh.group(group);
}

void SolidBody::pointsOf(GlobalOrdinal element, std::vector<Point>& points) const {
  std::array<GlobalOrdinal, 8> nodes{};
  const auto number = static_cast<std::size_t>(mesh.nodesPerElement());
  mesh.elementNodes(element, std::span(nodes).first(number));
  points.resize(number);
  for (std::size_t i = 0; i < number; ++i)
    points[i] = mesh.point(nodes[i]);
}

} // namespace epafi::fem
