#include "epafi/fem/SupportNormals.hpp"

#include "epafi/base/SortUnique.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace epafi::fem {
namespace {

using Eigen::Vector3d;

constexpr double flatAngle = 1e-6;                ///< normals of one plane differ by less
constexpr double smoothCosine = 0.76604444311898; ///< of 40°
constexpr double normalOnAxis = 1e-12;

/// A surface's facets around each of its nodes.
struct Facets {
  std::vector<GlobalOrdinal> nodes;              ///< ascending
  std::vector<std::vector<std::size_t>> at;      ///< facets at each of them
  std::vector<std::vector<std::size_t>> nodesOf; ///< places of the nodes of each facet
  std::vector<Vector3d> areas;                   ///< ∫n
  std::vector<Vector3d> normals;

  Facets(const mesh::Mesh& mesh, const mesh::Surface& surface) : nodes(surface.facetNodes) {
    sortUnique(nodes);
    at.resize(nodes.size());
    nodesOf.resize(surface.elements.size());
    std::vector<Point> corners;
    for (std::size_t f = 0; f < nodesOf.size(); ++f) {
      mesh.pointsAt(surface.facet(f), corners);
      areas.push_back(areaVector(surface.typeOf(f), corners));
      normals.push_back(areas.back().normalized());
      for (const GlobalOrdinal node : surface.facet(f)) {
        const std::size_t place = std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin();
        nodesOf[f].push_back(place);
        at[place].push_back(f);
      }
    }
  }
};

/// Planes among the facets: which plane each facet is in, and the planes' normals.
struct Planes {
  std::vector<std::size_t> of;
  std::vector<Vector3d> normals;

  /// From each facet that is in no plane yet the plane grows over the neighbours that agree with that facet.
  explicit Planes(const Facets& facets) : of(facets.areas.size(), facets.areas.size()) {
    for (std::size_t seed = 0; seed < of.size(); ++seed) {
      if (of[seed] < of.size())
        continue;
      Vector3d area(0, 0, 0);
      std::vector<std::size_t> front{seed};
      of[seed] = normals.size();
      while (!front.empty()) {
        const std::size_t facet = front.back();
        front.pop_back();
        area += facets.areas[facet];
        for (const std::size_t node : facets.nodesOf[facet])
          for (const std::size_t other : facets.at[node])
            if (of[other] == of.size() &&
                (facets.normals[other] - facets.normals[seed]).norm() <= flatAngle) {
              of[other] = normals.size();
              front.push_back(other);
            }
      }
      normals.push_back(area.normalized());
    }
  }
};

/// The facets at a node in groups, each facet within the angle of another one of its group.
std::vector<std::vector<std::size_t>> smoothGroups(const Facets& facets, std::vector<std::size_t> rest) {
  std::vector<std::vector<std::size_t>> groups;
  while (!rest.empty()) {
    std::vector<std::size_t> group{rest.front()};
    rest.erase(rest.begin());
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::size_t r = 0; r < rest.size();)
        if (facets.normals[group[k]].dot(facets.normals[rest[r]]) > smoothCosine) {
          group.push_back(rest[r]);
          rest.erase(rest.begin() + r);
        } else {
          ++r;
        }
    groups.push_back(std::move(group));
  }
  return groups;
}

Vector3d snapped(const Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const Vector3d nearest = std::copysign(1.0, normal[axis]) * Vector3d::Unit(axis);
  return (normal - nearest).norm() <= normalOnAxis ? nearest : normal;
}

} // namespace

std::vector<NodeNormal> supportNormals(const mesh::Mesh& mesh, const mesh::Surface& surface) {
  const Facets facets(mesh, surface);
  const Planes planes(facets);
  std::vector<NodeNormal> result;
  for (std::size_t place = 0; place < facets.nodes.size(); ++place)
    for (const auto& group : smoothGroups(facets, facets.at[place])) {
      const std::size_t plane = planes.of[group.front()];
      Vector3d normal = planes.normals[plane];
      if (std::any_of(group.begin(), group.end(),
                      [&](std::size_t facet) { return planes.of[facet] != plane; })) {
        normal.setZero();
        for (const std::size_t facet : group)
          normal += facets.areas[facet];
        normal.normalize();
      }
      result.push_back({facets.nodes[place], snapped(normal)});
    }
  return result;
}

} // namespace epafi::fem
