#include "epafi/fem/SolidModel.hpp"

#include "epafi/fem/BoxMesh.hpp"
#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FacetLoads.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi::fem {
namespace {

/// Whether a point lies in a box, its faces included.
bool liesIn(const Point& point, const scene::Box& box, int dimension) {
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
    if (!(box.lower[d] <= point[d] && point[d] <= box.upper[d]))
      return false;
  return true;
}

/// Corners of an element of a structured mesh that begins at the origin.
std::vector<Point> shapeOf(const Mesh& mesh) {
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

std::string listOf(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names)
    all += (all.empty() ? "'" : ", '") + name + "'";
  return all.empty() ? "none" : all;
}

std::string text(const Point& point) {
  return "(" + std::to_string(point[0]) + ", " + std::to_string(point[1]) + ", " + std::to_string(point[2]) +
         ")";
}

} // namespace

SolidModel::SolidModel(std::string name, const scene::Solid& solid, const Mesh& mesh)
    : name_(std::move(name)), solid_(solid), mesh_(mesh), components_(componentsOf(solid.physics)),
      shape_(shapeOf(mesh)), rigidModes_(makeRigidModes()) {
  requireDimension();
  if (components_ > 1 && !isCongruent())
    requireNoMechanism();
  for (const scene::SolidRegion& region : solid.regions)
    regions_.push_back(domainOf("region '" + region.name + "'", region.group, region.box));
  for (const scene::SolidLoad& load : solid.loads) {
    using Kind = scene::SolidLoad::Kind;
    loaded_.emplace_back();
    if (load.kind == Kind::body)
      loaded_.back() = domainOf("load '" + load.name + "'", load.where, load.box);
    else if (load.kind == Kind::point)
      loadPoint(load);
    else
      loadSurface(load);
  }
  std::stable_sort(forces_.begin(), forces_.end(),
                   [](const NodalForce& a, const NodalForce& b) { return a.element < b.element; });
  holdSupports();
  std::vector<HeldComponent> held;
  for (const Held& value : held_)
    held.push_back({mesh_.point(value.node), value.component});
  freeModes_ = rigidModes_.freeOf(held);
}

InputError SolidModel::refusal(const std::string& what) const {
  return InputError("body '" + name_ + "': " + what);
}

RigidModes SolidModel::makeRigidModes() const {
  Point lower = mesh_.point(0), upper = lower, centre{};
  for (GlobalOrdinal node = 0; node < mesh_.numNodes(); node += isCongruent() ? mesh_.numNodes() - 1 : 1) {
    const Point point = mesh_.point(node); // of a structured mesh the first and the last will do
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = std::min(lower[d], point[d]);
      upper[d] = std::max(upper[d], point[d]);
    }
  }
  double size = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    centre[d] = 0.5 * (lower[d] + upper[d]);
    size = std::max(size, upper[d] - lower[d]);
  }
  return {components_, centre, 0.5 * size};
}

void SolidModel::requireDimension() const {
  const int dimension = dimensionOf(mesh_.cellType());
  const bool isPlane = solid_.physics != scene::Physics::elasticity3d;
  if (isPlane != (dimension == 2))
    throw refusal("its physics is " + toString(solid_.physics) + ", but its mesh consists of " +
                  toString(mesh_.cellType()) + "s; choose " +
                  (isPlane ? "elasticity 3-D" : "membrane, plane strain or plane stress"));
}

/// Elements joined in facets move as one rigid body; those joined in less may turn about each other.
void SolidModel::requireNoMechanism() const {
  std::vector<char> isReached(static_cast<std::size_t>(mesh_.numElements()), 0);
  std::vector<GlobalOrdinal> front{0}, neighbours;
  isReached[0] = 1;
  GlobalOrdinal numReached = 1;
  while (!front.empty()) {
    const GlobalOrdinal element = front.back();
    front.pop_back();
    mesh_.elementNeighbours(element, neighbours);
    for (const GlobalOrdinal other : neighbours)
      if (isReached[static_cast<std::size_t>(other)] == 0) {
        isReached[static_cast<std::size_t>(other)] = 1;
        ++numReached;
        front.push_back(other);
      }
  }
  if (numReached < mesh_.numElements())
    throw refusal(
        "only " + std::to_string(numReached) + " of its " + std::to_string(mesh_.numElements()) +
        " elements are joined with each other in whole " +
        (dimensionOf(mesh_.cellType()) == 2 ? "edges" : "faces") +
        "; the others hang on nodes, or on nothing, and could turn: a mechanism. Make each part a body "
        "of its own, or join the parts in the mesh");
}

Surface SolidModel::surfaceOf(const std::string& user, const std::string& surface) const {
  const std::vector<std::string> names = mesh_.surfaceNames();
  if (std::find(names.begin(), names.end(), surface) == names.end())
    throw refusal(user + " names the surface '" + surface + "', which its mesh does not have; it has " +
                  listOf(names));
  return mesh_.surface(surface);
}

SolidModel::Domain SolidModel::domainOf(const std::string& user, const std::string& group,
                                        const scene::Box& box) const {
  Domain domain;
  domain.isGroup = !group.empty();
  domain.box = box;
  if (domain.isGroup) {
    const std::vector<std::string> names = mesh_.groupNames();
    if (std::find(names.begin(), names.end(), group) == names.end())
      throw refusal(user + " names the group '" + group + "', which its mesh does not have; it has " +
                    listOf(names));
    domain.elements = mesh_.group(group);
    return domain;
  }
  for (GlobalOrdinal element = 0; element < mesh_.numElements(); ++element)
    if (contains(domain, element))
      return domain;
  throw refusal(user + ": no element has its centre in its box");
}

bool SolidModel::contains(const Domain& domain, GlobalOrdinal element) const {
  if (domain.isGroup)
    return std::binary_search(domain.elements.begin(), domain.elements.end(), element);
  std::vector<Point> points;
  pointsOf(element, points);
  return liesIn(centreOf(points), domain.box, dimensionOf(mesh_.cellType()));
}

void SolidModel::pointsOf(GlobalOrdinal element, std::vector<Point>& points) const {
  std::array<GlobalOrdinal, 8> nodes{};
  const auto number = static_cast<std::size_t>(mesh_.nodesPerElement());
  mesh_.elementNodes(element, std::span(nodes).first(number));
  points.resize(number);
  for (std::size_t i = 0; i < number; ++i)
    points[i] = mesh_.point(nodes[i]);
}

/// 0 outside of all regions; the last one in the file holds.
std::size_t SolidModel::regionOf(GlobalOrdinal element) const {
  for (std::size_t r = regions_.size(); r > 0; --r)
    if (contains(regions_[r - 1], element))
      return r;
  return 0;
}

const scene::Material& SolidModel::material(std::size_t region) const {
  return region == 0 ? solid_.material : solid_.regions[region - 1].material;
}

const scene::Material& SolidModel::materialOf(GlobalOrdinal element) const {
  return material(regionOf(element));
}

void SolidModel::holdSupports() {
  for (const scene::SolidSupport& support : solid_.supports) {
    const Surface surface = surfaceOf("support '" + support.name + "'", support.surface);
    std::vector<GlobalOrdinal> nodes = surface.facetNodes;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const GlobalOrdinal node : nodes)
      for (int c = 0; c < components_; ++c)
        if (const auto& value = support.value[static_cast<std::size_t>(c)])
          held_.push_back({node, c, *value});
  }
  const auto place = [](const Held& held) { return std::pair(held.node, held.component); };
  std::stable_sort(held_.begin(), held_.end(),
                   [&](const Held& a, const Held& b) { return place(a) < place(b); });
  const auto contradiction =
      std::adjacent_find(held_.begin(), held_.end(), [&](const Held& a, const Held& b) {
        return place(a) == place(b) && a.value != b.value;
      });
  if (contradiction != held_.end())
    throw refusal("two supports hold the node at " + text(mesh_.point(contradiction->node)) +
                  " in component " + "xyz"[contradiction->component] + " at different values, " +
                  std::to_string(contradiction->value) + " and " +
                  std::to_string((contradiction + 1)->value));
  held_.erase(std::unique(held_.begin(), held_.end(),
                          [&](const Held& a, const Held& b) { return place(a) == place(b); }),
              held_.end());
}

std::optional<double> SolidModel::prescribed(GlobalOrdinal node, int component) const {
  const auto found = std::lower_bound(held_.begin(), held_.end(), std::pair(node, component),
                                      [](const Held& held, const std::pair<GlobalOrdinal, int>& wanted) {
                                        return std::pair(held.node, held.component) < wanted;
                                      });
  if (found == held_.end() || found->node != node || found->component != component)
    return std::nullopt;
  return found->value;
}

void SolidModel::prescribed(std::span<const GlobalOrdinal> nodes,
                            std::vector<PrescribedValue>& values) const {
  values.clear();
  if (nodes.empty())
    return;
  auto held = std::lower_bound(held_.begin(), held_.end(), nodes.front(),
                               [](const Held& h, GlobalOrdinal node) { return h.node < node; });
  for (auto node = nodes.begin(); held != held_.end() && held->node <= nodes.back(); ++held) {
    node = std::lower_bound(node, nodes.end(), held->node);
    if (node != nodes.end() && *node == held->node)
      values.push_back(
          {static_cast<std::size_t>(node - nodes.begin()) * static_cast<std::size_t>(components_) +
               static_cast<std::size_t>(held->component),
           held->value});
  }
}

/// Where elements are congruent the kind is the region, else the element.
void SolidModel::kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const {
  for (std::size_t e = 0; e < elements.size(); ++e)
    kinds[e] = isCongruent() ? static_cast<GlobalOrdinal>(regionOf(elements[e])) : elements[e];
}

void SolidModel::stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const {
  if (isCongruent()) {
    elementStiffness(mesh_.cellType(), shape_, solid_.physics, material(static_cast<std::size_t>(kind)),
                     stiffness);
    return;
  }
  std::vector<Point> points;
  pointsOf(kind, points);
  elementStiffness(mesh_.cellType(), points, solid_.physics, materialOf(kind), stiffness);
}

void SolidModel::loadSurface(const scene::SolidLoad& load) {
  const Surface surface = surfaceOf("load '" + load.name + "'", load.where);
  const auto perFacet = static_cast<std::size_t>(surface.nodesPerFacet);
  std::vector<Point> points(perFacet);
  Eigen::VectorXd values;
  for (std::size_t f = 0; f < surface.elements.size(); ++f) {
    const auto nodes = std::span(surface.facetNodes).subspan(f * perFacet, perFacet);
    std::transform(nodes.begin(), nodes.end(), points.begin(),
                   [&](GlobalOrdinal node) { return mesh_.point(node); });
    const scene::Material& material = materialOf(surface.elements[f]);
    if (load.kind == scene::SolidLoad::Kind::pressure)
      pressureLoad(points, solid_.physics, material, load.value[0], values);
    else
      tractionLoad(points, solid_.physics, material, load.value, values);
    for (std::size_t i = 0; i < perFacet; ++i) {
      NodalForce force{surface.elements[f], nodes[i], {0, 0, 0}};
      for (int c = 0; c < components_; ++c)
        force.force[static_cast<std::size_t>(c)] = values[static_cast<Eigen::Index>(i) * components_ + c];
      forces_.push_back(force);
    }
  }
}

GlobalOrdinal SolidModel::nodeAt(const scene::SolidLoad& load) const {
  GlobalOrdinal nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const int dimension = dimensionOf(mesh_.cellType());
  for (GlobalOrdinal node = 0; node < mesh_.numNodes(); ++node) {
    const Point point = mesh_.point(node);
    double distance = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      distance += (point[d] - load.point[d]) * (point[d] - load.point[d]);
    if (distance < least) {
      least = distance;
      nearest = node;
    }
  }
  std::vector<GlobalOrdinal> elements;
  mesh_.nodeElements(nearest, elements);
  std::vector<Point> points;
  pointsOf(elements.front(), points);
  double edge = 0;
  for (std::size_t d = 0; d < 3; ++d)
    edge = std::max(edge, std::abs(points[1][d] - points[0][d]));
  if (std::sqrt(least) > 1e-6 * edge)
    throw refusal("no node lies at the point " + text(load.point) + " of load '" + load.name +
                  "'; the nearest one is at " + text(mesh_.point(nearest)));
  return nearest;
}

void SolidModel::loadPoint(const scene::SolidLoad& load) {
  const GlobalOrdinal node = nodeAt(load);
  std::vector<GlobalOrdinal> elements;
  mesh_.nodeElements(node, elements);
  forces_.push_back({*std::min_element(elements.begin(), elements.end()), node, load.value});
}

void SolidModel::loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  const auto number = static_cast<std::size_t>(mesh_.nodesPerElement());
  loads.setZero(static_cast<Eigen::Index>(number) * components_, static_cast<Eigen::Index>(elements.size()));
  Eigen::VectorXd values;
  std::vector<Point> points;
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    if (solid_.loads[k].kind != scene::SolidLoad::Kind::body)
      continue;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (!contains(loaded_[k], elements[e]))
        continue;
      pointsOf(elements[e], points);
      bodyForceLoad(mesh_.cellType(), isCongruent() ? shape_ : points, solid_.physics,
                    materialOf(elements[e]), solid_.loads[k].value, values);
      loads.col(static_cast<Eigen::Index>(e)) += values;
    }
  }
  std::array<GlobalOrdinal, 8> nodes{};
  for (std::size_t e = 0; e < elements.size() && !forces_.empty(); ++e) {
    auto force =
        std::lower_bound(forces_.begin(), forces_.end(), elements[e],
                         [](const NodalForce& f, GlobalOrdinal element) { return f.element < element; });
    if (force == forces_.end() || force->element != elements[e])
      continue;
    mesh_.elementNodes(elements[e], std::span(nodes).first(number));
    for (; force != forces_.end() && force->element == elements[e]; ++force) {
      const auto corner =
          std::find(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(number), force->node);
      for (int c = 0; c < components_; ++c)
        loads((corner - nodes.begin()) * components_ + c, static_cast<Eigen::Index>(e)) +=
            force->force[static_cast<std::size_t>(c)];
    }
  }
}

} // namespace epafi::fem
