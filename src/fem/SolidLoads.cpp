#include "epafi/fem/SolidLoads.hpp"

#include "epafi/base/Text.hpp"
#include "epafi/fem/DistributedTraction.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace epafi::fem {
namespace {

/// ∫N over the part of the segment [a, b] that lies in [low, high], for the functions N of the segment of an
/// order.
std::array<double, 3> segmentLoad(double a, double b, double low, double high, int order) {
  const double from = std::max(a, low), to = std::min(b, high);
  if (to <= from)
    return {0, 0, 0};
  const double s = (0.5 * (from + to) - a) / (b - a), length = to - from;
  if (order == 1) // a linear function's value in the middle times the length
    return {length * (1 - s), length * s, 0};
  const double half = 0.5 * length / (b - a), square = s * s + half * half / 3; // mean of s²
  return {length * (1 - 3 * s + 2 * square), length * 4 * (s - square), length * (2 * square - s)};
}

/// The node that lies at the point of a load; nothing where a piece of a mesh does not hold it.
std::optional<GlobalOrdinal> nodeAt(const SolidBody& body, const SolidLoad& load) {
  const mesh::Mesh& mesh = body.mesh;
  const std::string nothing =
      "no node lies at the point " + text(load.point) + " of load '" + load.name + "'";
  GlobalOrdinal nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const int dimension = dimensionOf(mesh.cellType());
  const GlobalOrdinal numHeld =
      mesh.part() == nullptr ? mesh.numNodes() : static_cast<GlobalOrdinal>(mesh.part()->nodes().size());
  for (GlobalOrdinal held = 0; held < numHeld; ++held) {
    const GlobalOrdinal node = mesh.part() == nullptr ? held : mesh.part()->nodes()[held];
    const Point point = mesh.point(node);
    double distance = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      distance += (point[d] - load.point[d]) * (point[d] - load.point[d]);
    if (distance < least) {
      least = distance;
      nearest = node;
    }
  }
  if (numHeld == 0) {
    body.require(false, nothing);
    return std::nullopt;
  }
  std::vector<GlobalOrdinal> elements;
  mesh.nodeElements(nearest, elements);
  std::vector<Point> points;
  mesh.elementPoints(elements.front(), points);
  double edge = 0;
  for (std::size_t d = 0; d < 3; ++d)
    edge = std::max(edge, std::abs(points[1][d] - points[0][d]));
  const bool isThere = std::sqrt(least) <= 1e-6 * edge, isPiece = mesh.part() != nullptr;
  body.require(isThere, isPiece ? nothing : nothing + "; the nearest one is at " + text(mesh.point(nearest)));
  if (isThere)
    return nearest;
  return std::nullopt;
}

} // namespace

SolidLoads::SolidLoads(const SolidBody& body, const SolidRegions& regions) : isHeated_(isHeated(body.solid)) {
  for (const SolidLoad& load : body.solid.loads) {
    using Kind = SolidLoad::Kind;
    if (load.kind == Kind::point)
      addPoint(body, load);
    else if (load.kind == Kind::temperature)
      addTemperature(body, load);
    else if (load.kind != Kind::body && load.kind != Kind::rotation)
      addSurface(body, regions, load);
    else if (!load.wholeElements && body.isCongruent())
      addGridForce(body, load);
    else
      bodyForces_.push_back(
          {SolidDomain(body, "load '" + load.name + "'", load.where, load.box, !load.wholeElements), &load});
  }
  sortForces();
}

void SolidLoads::sortForces() {
  std::stable_sort(forces_.begin(), forces_.end(),
                   [](const NodalForce& a, const NodalForce& b) { return a.element < b.element; });
}

void SolidLoads::addForceAt(const mesh::Mesh& mesh, GlobalOrdinal node, const Vector3& force) {
  enterForce(mesh, node, force);
  sortForces();
}

void SolidLoads::addGridForce(const SolidBody& body, const SolidLoad& load) {
  const mesh::StructuredMesh& mesh = *body.mesh.structured();
  GridForce force{load.value, {}};
  for (std::size_t d = 0; d < 3; ++d)
    force.shares[d].assign(mesh.elements()[d], {0, 0, 0});
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t k = 0; k < force.shares[d].size(); ++k)
      force.shares[d][k] = segmentLoad(mesh.coordinate(d, k), mesh.coordinate(d, k + 1), load.box.lower[d],
                                       load.box.upper[d], orderOf(mesh.cellType()));
  if (mesh.dimension() == 2)
    force.shares[2].front() = {1, 0, 0};
  gridForces_.push_back(std::move(force));
}

void SolidLoads::addSurface(const SolidBody& body, const SolidRegions& regions, const SolidLoad& load) {
  const Physics physics = body.solid.physics;
  const mesh::Surface surface = body.surfaceOf("load '" + load.name + "'", load.where);
  const int components = body.components();
  std::vector<Point> points;
  Eigen::VectorXd values;
  const auto materialAt = [&](std::size_t f) -> const Material& {
    return materialIn(body.solid, regions.of(body, surface.elements[f]));
  };
  std::optional<DistributedTraction> distributed;
  if (load.kind == SolidLoad::Kind::distributed)
    distributed.emplace(body, surface, load, materialAt);
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const std::span<const GlobalOrdinal> nodes = surface.facet(f);
    body.mesh.pointsAt(nodes, points);
    const Material& material = materialAt(f);
    if (distributed)
      distributed->of(surface.typeOf(f), points, material, values);
    else if (load.kind == SolidLoad::Kind::pressure)
      pressureLoad(surface.typeOf(f), points, physics, material, load.value[0], values,
                   integrationOf(body.solid));
    else
      tractionLoad(surface.typeOf(f), points, physics, material, load.value, values,
                   integrationOf(body.solid));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      NodalForce force{surface.elements[f], nodes[i], {0, 0, 0}};
      for (int c = 0; c < components; ++c)
        force.force[c] = values[static_cast<Eigen::Index>(i) * components + c];
      forces_.push_back(force);
    }
  }
}

void SolidLoads::addTemperature(const SolidBody& body, const SolidLoad& load) {
  if (body.components() == 1)
    throw body.refusal("load '" + load.name + "' is a temperature, by which a membrane does not expand");
  if (load.where.empty())
    heatedBy_ += load.value[0];
  else
    for (const GlobalOrdinal node : body.nodesOf("load '" + load.name + "'", load.where))
      heated_[node] += load.value[0];
}

void SolidLoads::addPoint(const SolidBody& body, const SolidLoad& load) {
  if (!load.where.empty())
    for (const GlobalOrdinal node : body.nodesOf("load '" + load.name + "'", load.where))
      enterForce(body.mesh, node, load.value);
  else if (const std::optional<GlobalOrdinal> node = nodeAt(body, load))
    enterForce(body.mesh, *node, load.value);
}

void SolidLoads::enterForce(const mesh::Mesh& mesh, GlobalOrdinal node, const Vector3& force) {
  std::vector<GlobalOrdinal> elements;
  mesh.nodeElements(node, elements);
  if (elements.empty()) // of a piece of a mesh
    return;
  forces_.push_back({*std::min_element(elements.begin(), elements.end()), node, force});
}

void SolidLoads::of(const SolidBody& body, const SolidRegions& regions, const SolidFactors& factors,
                    std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  const int components = body.components();
  loads.setZero(static_cast<Eigen::Index>(body.mesh.nodesPerElement()) * components, elements.size());
  if (!gridForces_.empty())
    addGridForces(body, regions, elements, loads);
  addBodyForces(body, regions, elements, loads);
  if (isHeated_)
    addThermalLoads(body, regions, factors, elements, loads);
  if (!forces_.empty())
    addNodalForces(body.mesh, components, elements, loads);
}

void SolidLoads::addGridForces(const SolidBody& body, const SolidRegions& regions,
                               std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  const mesh::StructuredMesh& mesh = *body.mesh.structured();
  const int components = body.components();
  std::vector<double> thickness; // of plane elastic bodies; else 1
  if (components == 2) {
    std::vector<GlobalOrdinal> region(elements.size());
    regions.of(body, elements, region);
    for (const GlobalOrdinal r : region)
      thickness.push_back(thicknessOf(body.solid.physics, materialIn(body.solid, r)));
  }
  const std::size_t perElement = loads.rows();
  for (const GridForce& force : gridForces_) {
    mesh::GridWalk walk = mesh.elementWalk();
    double* load = loads.data();
    for (std::size_t e = 0; e < elements.size(); ++e, load += perElement) {
      walk.to(elements[e]);
      const auto share = [&](std::size_t d) { return force.shares[d][walk[d]]; };
      const auto x = share(0), y = share(1), z = share(2);
      const auto isBeside = [](const auto& part) { return part[0] == 0 && part[1] == 0 && part[2] == 0; };
      if (isBeside(x) || isBeside(y) || isBeside(z))
        continue;
      const double factor = thickness.empty() ? 1 : thickness[e];
      double* next = load;
      for (const auto& place : mesh.places()) {
        const double product = x[place[0]] * y[place[1]] * z[place[2]];
        for (int c = 0; c < components; ++c)
          *next++ += factor * force.value[c] * product;
      }
    }
  }
}

void SolidLoads::addBodyForces(const SolidBody& body, const SolidRegions& regions,
                               std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  Eigen::VectorXd values;
  std::vector<Point> points;
  for (const BodyForce& force : bodyForces_)
    force.domain.forEachIn(body, elements, [&](std::size_t e) {
      const Material& material = materialIn(body.solid, regions.of(body, elements[e]));
      const SolidLoad& load = *force.load;
      if (load.kind == SolidLoad::Kind::rotation) {
        body.mesh.elementPoints(elements[e], points);
        rotationLoad(cellOf(body.mesh.cellType(), points.size()), points, body.solid.physics, material, load,
                     values, integrationOf(body.solid));
      } else {
        body.cornersOf(elements[e], points);
        bodyForceLoad(cellOf(body.mesh.cellType(), points.size()), points, body.solid.physics, material,
                      load.value, values, integrationOf(body.solid));
      }
      loads.col(e).head(values.size()) += values;
    });
}

void SolidLoads::temperatureChange(const mesh::Mesh& mesh, GlobalOrdinal element,
                                   std::vector<double>& change) const {
  change.clear();
  if (!isHeated_)
    return;
  for (const GlobalOrdinal node : mesh::ElementNodes(mesh, element)) {
    const auto own = heated_.find(node);
    change.push_back(heatedBy_ + (own == heated_.end() ? 0 : own->second));
  }
}

void SolidLoads::addThermalLoads(const SolidBody& body, const SolidRegions& regions,
                                 const SolidFactors& factors, std::span<const GlobalOrdinal> elements,
                                 Eigen::MatrixXd& loads) const {
  std::vector<GlobalOrdinal> region(elements.size());
  regions.of(body, elements, region);
  std::vector<Point> points;
  std::vector<double> change, stiffness;
  Eigen::VectorXd values;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    body.cornersOf(elements[e], points);
    temperatureChange(body.mesh, elements[e], change);
    factors.of(body.mesh, elements[e], stiffness);
    thermalLoad(cellOf(body.mesh.cellType(), points.size()), points, body.solid.physics,
                materialIn(body.solid, region[e]), change, values, integrationOf(body.solid), stiffness);
    loads.col(e).head(values.size()) += values;
  }
}

void SolidLoads::addNodalForces(const mesh::Mesh& mesh, int components,
                                std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  for (std::size_t e = 0; e < elements.size(); ++e) {
    auto force =
        std::lower_bound(forces_.begin(), forces_.end(), elements[e],
                         [](const NodalForce& f, GlobalOrdinal element) { return f.element < element; });
    if (force == forces_.end() || force->element != elements[e])
      continue;
    const mesh::ElementNodes nodes(mesh, elements[e]);
    for (; force != forces_.end() && force->element == elements[e]; ++force) {
      const auto corner = std::find(nodes.begin(), nodes.end(), force->node) - nodes.begin();
      for (int c = 0; c < components; ++c)
        loads(corner * components + c, e) += force->force[c];
    }
  }
}

} // namespace epafi::fem
