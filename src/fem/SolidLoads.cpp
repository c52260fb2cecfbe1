#include "epafi/fem/SolidLoads.hpp"

#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FacetLoads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace epafi::fem {
namespace {

/// The node that lies at the point of a load.
GlobalOrdinal nodeAt(const SolidBody& body, const scene::SolidLoad& load) {
  const Mesh& mesh = body.mesh;
  GlobalOrdinal nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const int dimension = dimensionOf(mesh.cellType());
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
    const Point point = mesh.point(node);
    double distance = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      distance += (point[d] - load.point[d]) * (point[d] - load.point[d]);
    if (distance < least) {
      least = distance;
      nearest = node;
    }
  }
  std::vector<GlobalOrdinal> elements;
  mesh.nodeElements(nearest, elements);
  std::vector<Point> points;
  body.pointsOf(elements.front(), points);
  double edge = 0;
  for (std::size_t d = 0; d < 3; ++d)
    edge = std::max(edge, std::abs(points[1][d] - points[0][d]));
  if (std::sqrt(least) > 1e-6 * edge)
    throw body.refusal("no node lies at the point " + text(load.point) + " of load '" + load.name +
                       "'; the nearest one is at " + text(mesh.point(nearest)));
  return nearest;
}

} // namespace

SolidLoads::SolidLoads(const SolidBody& body, const SolidRegions& regions) {
  for (const scene::SolidLoad& load : body.solid.loads) {
    using Kind = scene::SolidLoad::Kind;
    if (load.kind == Kind::body)
      bodyForces_.push_back(
          {SolidDomain(body, "load '" + load.name + "'", load.where, load.box), load.value});
    else if (load.kind == Kind::point)
      addPoint(body, load);
    else
      addSurface(body, regions, load);
  }
  std::stable_sort(forces_.begin(), forces_.end(),
                   [](const NodalForce& a, const NodalForce& b) { return a.element < b.element; });
}

void SolidLoads::addSurface(const SolidBody& body, const SolidRegions& regions,
                            const scene::SolidLoad& load) {
  const scene::Physics physics = body.solid.physics;
  const Surface surface = body.surfaceOf("load '" + load.name + "'", load.where);
  const auto perFacet = static_cast<std::size_t>(surface.nodesPerFacet);
  const int components = body.components();
  std::vector<Point> points(perFacet);
  Eigen::VectorXd values;
  for (std::size_t f = 0; f < surface.elements.size(); ++f) {
    const auto nodes = std::span(surface.facetNodes).subspan(f * perFacet, perFacet);
    std::transform(nodes.begin(), nodes.end(), points.begin(),
                   [&](GlobalOrdinal node) { return body.mesh.point(node); });
    const scene::Material& material = materialIn(body.solid, regions.regionOf(body, surface.elements[f]));
    if (load.kind == scene::SolidLoad::Kind::pressure)
      pressureLoad(points, physics, material, load.value[0], values);
    else
      tractionLoad(points, physics, material, load.value, values);
    for (std::size_t i = 0; i < perFacet; ++i) {
      NodalForce force{surface.elements[f], nodes[i], {0, 0, 0}};
      for (int c = 0; c < components; ++c)
        force.force[static_cast<std::size_t>(c)] = values[static_cast<Eigen::Index>(i) * components + c];
      forces_.push_back(force);
    }
  }
}

void SolidLoads::addPoint(const SolidBody& body, const scene::SolidLoad& load) {
  const GlobalOrdinal node = nodeAt(body, load);
  std::vector<GlobalOrdinal> elements;
  body.mesh.nodeElements(node, elements);
  forces_.push_back({*std::min_element(elements.begin(), elements.end()), node, load.value});
}

void SolidLoads::of(const SolidBody& body, const SolidRegions& regions,
                    std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  const auto components = static_cast<std::size_t>(body.components());
  loads.setZero(static_cast<Eigen::Index>(static_cast<std::size_t>(body.mesh.nodesPerElement()) * components),
                static_cast<Eigen::Index>(elements.size()));
  Eigen::VectorXd values;
  std::vector<Point> points;
  for (const BodyForce& force : bodyForces_)
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (!force.domain.contains(body, elements[e]))
        continue;
      body.cornersOf(elements[e], points);
      bodyForceLoad(body.mesh.cellType(), points, body.solid.physics,
                    materialIn(body.solid, regions.regionOf(body, elements[e])), force.value, values);
      loads.col(static_cast<Eigen::Index>(e)) += values;
    }
  if (!forces_.empty())
    addNodalForces(body.mesh, components, elements, loads);
}

void SolidLoads::addNodalForces(const Mesh& mesh, std::size_t components,
                                std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  std::array<GlobalOrdinal, 8> nodes{};
  const auto number = static_cast<std::size_t>(mesh.nodesPerElement());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    auto force =
        std::lower_bound(forces_.begin(), forces_.end(), elements[e],
                         [](const NodalForce& f, GlobalOrdinal element) { return f.element < element; });
    if (force == forces_.end() || force->element != elements[e])
      continue;
    mesh.elementNodes(elements[e], std::span(nodes).first(number));
    for (; force != forces_.end() && force->element == elements[e]; ++force) {
      const auto corner = static_cast<std::size_t>(
          std::find(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(number), force->node) -
          nodes.begin());
      for (std::size_t c = 0; c < components; ++c)
        loads(static_cast<Eigen::Index>(corner * components + c), static_cast<Eigen::Index>(e)) +=
            force->force[c];
    }
  }
}

} // namespace epafi::fem
