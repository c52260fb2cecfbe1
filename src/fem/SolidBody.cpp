#include "epafi/fem/SolidBody.hpp"

#include "epafi/base/SortUnique.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <algorithm>

namespace epafi::fem {
namespace {

/// Throws unless the name is among those of the mesh. \param what  "surface" or "group"
void requireName(const SolidBody& body, const std::string& user, const std::string& what,
                 const std::string& name, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end())
    return;
  std::string all;
  for (const std::string& known : names)
    all += (all.empty() ? "'" : ", '") + known + "'";
  throw body.refusal(user + " names the " + what + " '" + name + "', which its mesh does not have; it has " +
                     (all.empty() ? "none" : all));
}

} // namespace

void SolidBody::require(bool isMet, const std::string& why) const {
  if (mesh.part() != nullptr)
    needs_->push_back({isMet, refusal(why).what()});
  else if (!isMet)
    throw refusal(why);
}

std::array<Point, 2> SolidBody::box() const {
  if (mesh.part() != nullptr)
    return mesh.part()->box();
  std::vector<Point> points; // of a structured mesh the first and the last will do
  const GlobalOrdinal step = mesh.structured() != nullptr ? mesh.numNodes() - 1 : 1;
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); node += step)
    points.push_back(mesh.point(node));
  return mesh::boxOf(points);
}

double SolidBody::axisTolerance() const {
  const auto [lower, upper] = box();
  return 1e-9 * std::max(upper[0] - lower[0], upper[1] - lower[1]);
}

mesh::Surface SolidBody::surfaceOf(const std::string& user, const std::string& surface) const {
  requireName(*this, user, "surface", surface, mesh.surfaceNames());
  return mesh.surface(surface);
}

std::vector<GlobalOrdinal> SolidBody::nodesOf(const std::string& user, const std::string& name) const {
  std::vector<std::string> names = mesh.surfaceNames();
  const std::vector<std::string> sets = mesh.nodeSetNames();
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    std::vector<GlobalOrdinal> nodes = mesh.surface(name).facetNodes;
    sortUnique(nodes);
    return nodes;
  }
  names.insert(names.end(), sets.begin(), sets.end());
  requireName(*this, user, sets.empty() ? "surface" : "surface or set of nodes", name, names);
  return mesh.nodeSet(name);
}

std::vector<GlobalOrdinal> SolidBody::groupOf(const std::string& user, const std::string& group) const {
  requireName(*this, user, "group", group, mesh.groupNames());
  return mesh.group(group);
}

void SolidBody::cornersOf(GlobalOrdinal element, std::vector<Point>& points) const {
  if (isCongruent())
    points = shape;
  else
    mesh.elementPoints(element, points);
}

} // namespace epafi::fem
