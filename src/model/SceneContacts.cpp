#include "epafi/model/SceneContacts.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/KnownRows.hpp"
#include "epafi/contact/QuadraticFaces.hpp"
#include "epafi/contact/UnitedSurface.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/MeshPart.hpp"
#include "epafi/model/ContactCoupler.hpp"
#include "epafi/model/ContactGroups.hpp"
#include "epafi/model/ContactSurfaces.hpp"
#include "epafi/model/TiedNodes.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace epafi::model {
namespace {

using contact::ContactLayout;

/// Throws if the scene names bodies that are not there, or what it says of edges does not hold.
void requireSound(const scene::Scene& scene, std::size_t number) {
  const scene::SurfaceContact& contact = scene.contacts[number];
  const std::string who = "contact '" + contact.name + "' ";
  for (const int body : {contact.first, contact.second})
    if (body < -1 || body >= std::ssize(scene.bodies) || contact.first < 0)
      throw InputError(who + "names body number " + std::to_string(body) + ", but the scene has " +
                       std::to_string(scene.bodies.size()) + " bodies, numbered from 0");
  if (!isAlongEdges(scene, contact))
    return;
  if (const auto fault = faultOf(scene, number))
    throw InputError(who +
                     (fault->side < 0    ? ""
                      : fault->side == 0 ? "cannot have its first edge: "
                                         : "cannot have its second edge: ") +
                     fault->objection);
}

/// Gaps are differences of coordinates, beside what the scene gives: what is round-off of these is neither a
/// gap nor an overlap.
void dropRoundOff(const scene::SurfaceContact& terms, const std::vector<BodyLayout>& bodies,
                  ContactLayout& contact) {
  constexpr double roundOff = 1e-13;
  const mesh::Mesh& mesh = *bodies[contact.firstBody].mesh;
  double largest = 0;
  for (const GlobalOrdinal node : contact.firstNodes)
    for (const double coordinate : mesh.point(node))
      largest = std::max(largest, std::abs(coordinate));
  if (contact.secondBody < 0) {
    for (const double coordinate : terms.obstacle.point)
      largest = std::max(largest, std::abs(coordinate));
    if (terms.obstacle.kind != scene::Obstacle::Kind::plane)
      largest = std::max(largest, terms.obstacle.radius);
  }
  for (double& gap : contact.gaps)
    gap = std::abs(gap - terms.gap) <= roundOff * largest ? terms.gap : gap;
}

/// ∫N̂ of a row, of all or of a part of the surface; ∫N of a node may be 0.
double areaAt(const ContactLayout& layout, const std::vector<double>& areas, std::size_t row) {
  if (layout.isDual || layout.smoothed.empty())
    return areas[row];
  double area = 0;
  for (const ContactLayout::Share& share : layout.smoothed[row])
    area += share.weight * areas[share.node];
  return area;
}

/// One layout for each contact of a group, with its parts of the rows.
std::vector<ContactLayout> partsOf(const ContactLayout& whole, const ContactGroup& group) {
  std::vector<ContactLayout> layouts;
  for (std::size_t part = 0; part < group.numbers.size(); ++part) {
    ContactLayout& layout = layouts.emplace_back(whole);
    layout.number = group.numbers[part];
    if (group.numbers.size() == 1)
      continue;
    layout.name = group.terms[part].name;
    layout.firstSurface = whole.firstSurfaces[part];
    layout.hasOwnRows = part == 0;
    layout.portions.clear();
    for (std::size_t row = 0; row < whole.areas.size(); ++row)
      layout.portions.push_back(areaAt(whole, whole.areasOfParts[part], row) /
                                areaAt(whole, whole.areas, row));
    std::string others;
    for (std::size_t other = 0; other < group.terms.size(); ++other)
      if (other != part)
        others += (others.empty() ? "'" : ", '") + group.terms[other].name + "'";
    layout.means += ", with " + others + " as one surface";
  }
  return layouts;
}

} // namespace

ContactLayout layoutContact(const scene::SurfaceContact& terms, const std::vector<BodyLayout>& bodies,
                            int components, const SupportedNodes& supported) {
  const ContactGroup group{{0}, {terms}, true};
  return Coupler(group, bodies, components, supported, nullptr).layout();
}

SupportedNodes supportedNodes(const std::vector<std::unique_ptr<fem::BodyModel>>& models) {
  const auto modelOf = [&models](int body) -> const fem::BodyModel& { return *models[body]; };
  SupportedNodes result;
  result.isHeld = [modelOf](int body, GlobalOrdinal node, const Eigen::Vector3d& direction) {
    constexpr double held = 1e-6; // of a direction, what is free beside it is round-off
    const fem::BodyModel& model = modelOf(body);
    const Eigen::Matrix3d* frame = model.frame(node);
    const Eigen::Vector3d along =
        frame != nullptr ? Eigen::Vector3d(frame->transpose() * direction) : direction;
    double free = 0;
    for (int c = 0; c < model.components(); ++c)
      if (!model.prescribed(node, c))
        free = std::hypot(free, along[c]);
    return free <= held;
  };
  result.heldAxes = [modelOf](int body, GlobalOrdinal node) {
    const fem::BodyModel& model = modelOf(body);
    const Eigen::Matrix3d* frame = model.frame(node);
    std::vector<Eigen::Vector3d> axes;
    for (int c = 0; c < model.components(); ++c)
      if (model.prescribed(node, c))
        axes.push_back(frame != nullptr ? Eigen::Vector3d(frame->col(c)) : Eigen::Vector3d::Unit(c));
    return axes;
  };
  result.axes = [modelOf](int body, const mesh::Surface& surface) {
    const fem::BodyModel& model = modelOf(body);
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    int most = 0;
    for (const GlobalOrdinal node : surface.facetNodes) {
      const Eigen::Matrix3d* frame = model.frame(node);
      int held = 0;
      for (int c = 0; c < model.components(); ++c)
        held += model.prescribed(node, c) ? 1 : 0;
      if (frame != nullptr && held > most) {
        most = held;
        axes = *frame;
      }
    }
    return axes;
  };
  return result;
}

namespace {

/// What the layouts of a scene need beside supports.
SupportedNodes withBodies(SupportedNodes supported, const scene::Scene& scene,
                          const std::vector<BodyLayout>& bodies) {
  supported.areOfRevolution = scene.bodies.front().physics == fem::Physics::axisymmetric;
  supported.thicknesses = [&](int body, const mesh::Surface& surface) {
    const scene::Body& solid = scene.bodies[body];
    if (solid.physics != fem::Physics::planeStrain && solid.physics != fem::Physics::planeStress)
      return std::vector<double>();
    std::vector<double> thicknesses(surface.numFacets(), solid.material.thickness);
    if (solid.regions.empty())
      return thicknesses;
    const fem::BodyModel model(solid, *bodies[body].mesh);
    for (std::size_t f = 0; f < thicknesses.size(); ++f)
      thicknesses[f] = model.materialOf(surface.elements[f]).thickness;
    return thicknesses;
  };
  auto boxes = std::make_shared<std::map<int, std::array<Point, 2>>>();
  supported.extent = [&, boxes](int body, const Eigen::Vector3d& direction) {
    const mesh::Mesh& mesh = *bodies[body].mesh;
    const auto [entry, isNew] = boxes->try_emplace(body);
    if (isNew && mesh.part() != nullptr) {
      entry->second = mesh.part()->box();
    } else if (isNew) {
      std::vector<Point> points;
      for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
        points.push_back(mesh.point(node));
      entry->second = mesh::boxOf(points);
    }
    double extent = 0;
    for (std::size_t d = 0; d < 3; ++d)
      extent += std::abs(direction[d]) * (entry->second[1][d] - entry->second[0][d]);
    return extent;
  };
  return supported;
}

/// Numbers rows, contact after contact; those that share rows have the first one's numbers.
void numberRows(const std::vector<ContactGroup>& groups, std::vector<ContactLayout>& layouts) {
  std::sort(layouts.begin(), layouts.end(),
            [](const ContactLayout& a, const ContactLayout& b) { return a.number < b.number; });
  std::map<int, GlobalOrdinal> firstRows;
  GlobalOrdinal firstRow = 0;
  for (ContactLayout& layout : layouts) {
    if (layout.hasOwnRows) {
      firstRows[layout.number] = layout.firstRow = firstRow;
      firstRow += layout.numRows();
      continue;
    }
    for (const ContactGroup& group : groups)
      if (std::find(group.numbers.begin(), group.numbers.end(), layout.number) != group.numbers.end())
        layout.firstRow = firstRows.at(group.numbers.front());
  }
}

/// Numbers nodes with friction, contact after contact; of those that share rows one is enough.
void numberFriction(const scene::Scene& scene, std::vector<ContactLayout>& contacts) {
  std::map<GlobalOrdinal, GlobalOrdinal> firstNodes; // by the first row
  GlobalOrdinal numNodes = 0;
  for (const ContactLayout& contact : contacts)
    if (scene.contacts[contact.number].hasFriction() &&
        firstNodes.try_emplace(contact.firstRow, numNodes).second)
      numNodes += contact.numRows();
  for (ContactLayout& contact : contacts)
    if (const auto first = firstNodes.find(contact.firstRow); first != firstNodes.end())
      contact.firstFriction = first->second;
}

/// The areas of rows that were left out count with those of earlier contacts that say the same.
void addDropped(const std::vector<contact::KnownRows::Dropped>& dropped, ContactLayout& contact,
                std::vector<ContactLayout>& earlier) {
  std::string names;
  for (const contact::KnownRows::Dropped& row : dropped)
    for (ContactLayout& other : earlier)
      if (other.number == row.contact) {
        other.areas[row.row] += row.area;
        names = "'" + other.name + "'";
        other.note = "contact '" + contact.name + "' says the same at some nodes, which count here";
      }
  if (!dropped.empty())
    contact.note = std::to_string(dropped.size()) +
                   (dropped.size() == 1 ? " more node counts" : " more nodes count") + " with contact " +
                   names + ", which says the same there";
}

} // namespace

SceneContacts layoutContacts(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                             const SupportedNodes& supports) {
  for (std::size_t number = 0; number < scene.contacts.size(); ++number)
    requireSound(scene, number);
  const SupportedNodes supported = withBodies(supports, scene, bodies);
  std::vector<ContactGroup> groups = contactGroups(scene, bodies);
  SceneContacts all;
  contact::KnownRows known;
  const auto layOut = [&](ContactGroup& group, const TiedNodes* tied) {
    scene::SurfaceContact& terms = group.terms.front();
    std::string why = ", as asked";
    if (terms.second >= 0 && terms.multipliers == scene::SurfaceContact::Side::automatic) {
      why = ", the first one";
      terms.multipliers = scene::SurfaceContact::Side::first;
      if (group.mayEitherCarry) {
        terms.multipliers = scene::SurfaceContact::Side::automatic;
        why = chooseSide(scene, bodies, terms);
      }
    }
    const int components = componentsOf(scene.bodies[terms.first].physics);
    ContactLayout layout = Coupler(group, bodies, components, supported, tied).layout();
    layout.number = group.numbers.front();
    dropRoundOff(terms, bodies, layout);
    if (!layout.firstShares.empty())
      layout.means += why;
    return layout;
  };
  const auto enter = [](std::vector<ContactLayout> parts, std::vector<ContactLayout>& layouts) {
    std::move(parts.begin(), parts.end(), std::back_inserter(layouts));
  };
  for (ContactGroup& group : groups)
    if (group.terms.front().kind == scene::SurfaceContact::Kind::tied)
      enter(partsOf(layOut(group, nullptr), group), all.ties);
  noteCircles(all.ties);
  const TiedNodes tied(all.ties);
  for (ContactGroup& group : groups) {
    if (group.terms.front().kind == scene::SurfaceContact::Kind::tied)
      continue;
    ContactLayout layout = layOut(group, &tied);
    const mesh::Mesh& mesh = *bodies[layout.firstBody].mesh;
    const mesh::Surface surface = contact::unite(mesh, layout.firstSurfaces).surface;
    addDropped(known.dropFrom(layout, spacingOf(mesh, surface)), layout, all.contacts);
    layout.firstShares.empty() ? contact::adaptRows(surface, layout) : contact::smoothRows(surface, layout);
    enter(partsOf(layout, group), all.contacts);
  }
  numberRows(groups, all.contacts);
  numberFriction(scene, all.contacts);
  for (ContactLayout& tie : all.ties)
    if (scene.contacts[tie.number].preload)
      all.sections.push_back(std::move(tie));
  std::erase_if(all.ties,
                [&](const ContactLayout& tie) { return scene.contacts[tie.number].preload.has_value(); });
  numberRows(groups, all.ties);
  return all;
}

contact::NodeUnknowns nodeUnknowns(const std::vector<BodyLayout>& bodies,
                                   const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                                   const RCP<const Comm>& comm) {
  contact::NodeUnknowns unknowns;
  unknowns.components = models.front()->components();
  unknowns.firstNode = firstNodes(bodies);
  const auto modelOf = [&models](int body) -> const fem::BodyModel& { return *models[body]; };
  unknowns.frame = [modelOf](int body, GlobalOrdinal node) { return modelOf(body).frame(node); };
  unknowns.isHeld = [modelOf](int body, GlobalOrdinal node, int component) {
    return modelOf(body).prescribed(node, component).has_value();
  };
  unknowns.isMine = [&bodies, share = shareOf(bodies, *comm)](int body, GlobalOrdinal node) {
    const BodyLayout& layout = bodies[body];
    const int part = lowestPartAt(layout, node), lowest = layout.firstSubdomain + part;
    return part < layout.partition->numParts() && share.begin <= lowest && lowest < share.end;
  };
  return unknowns;
}

} // namespace epafi::model
