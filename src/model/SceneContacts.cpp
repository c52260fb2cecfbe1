#include "epafi/model/SceneContacts.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/ContactSearch.hpp"
#include "epafi/contact/KnownRows.hpp"
#include "epafi/contact/MortarRows.hpp"
#include "epafi/contact/QuadraticFaces.hpp"
#include "epafi/model/ContactSurfaces.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace epafi::model {
namespace {

using contact::ContactLayout;

/// A side of a contact.
struct Side {
  int body;
  std::string surface;
};

contact::NodePoints pointsOf(const BodyLayout& body) {
  return [mesh = body.mesh.get()](GlobalOrdinal node) { return mesh->point(node); };
}

/// The nodes of a side. \param order  of the facets between them, at least
contact::SurfaceNodes nodesOf(const scene::SurfaceContact& contact, const BodyLayout& body,
                              const std::string& surface, int order) {
  return contact::surfaceNodes(pointsOf(body), surfaceOf(contact, body, surface), order);
}

/// Whether nodes along two edges of structured meshes meet in order.
bool haveEqualEdges(const scene::SurfaceContact& terms, const std::vector<BodyLayout>& bodies) {
  const auto numElements = [&](int body, const std::string& edge) {
    const fem::StructuredMesh* mesh = bodies[static_cast<std::size_t>(body)].mesh->structured();
    return mesh == nullptr ? 0 : mesh->elements()[edge == "left" || edge == "right" ? 1 : 0];
  };
  const auto number = numElements(terms.first, terms.firstSurface);
  return number > 0 && number == numElements(terms.second, terms.secondSurface);
}

contact::Obstacle obstacleOf(const scene::Obstacle& obstacle) {
  using Kind = contact::Obstacle::Kind;
  return {obstacle.kind == scene::Obstacle::Kind::plane ? Kind::plane : Kind::sphere,
          {obstacle.point[0], obstacle.point[1], obstacle.point[2]},
          {obstacle.normal[0], obstacle.normal[1], obstacle.normal[2]},
          obstacle.radius};
}

/// Throws if the scene names bodies that are not there, or what it says of edges does not hold.
void requireSound(const scene::Scene& scene, std::size_t number) {
  const scene::SurfaceContact& contact = scene.contacts[number];
  const std::string who = "contact '" + contact.name + "' ";
  for (const int body : {contact.first, contact.second})
    if (body < -1 || body >= static_cast<int>(scene.bodies.size()) || contact.first < 0)
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

} // namespace

ContactLayout layoutContact(const scene::SurfaceContact& terms, const std::vector<BodyLayout>& bodies,
                            int components, const SupportedNodes& supported) {
  using Coupling = scene::SurfaceContact::Coupling;
  const auto layoutOf = [&](const Side& side) -> const BodyLayout& {
    return bodies[static_cast<std::size_t>(side.body)];
  };
  const auto orderOf = [&](const Side& side) { return fem::orderOf(layoutOf(side).mesh->cellType()); };
  const auto finish = [&](ContactLayout layout, const Side& first, const Side& second, std::string means) {
    layout.firstBody = first.body;
    layout.firstSurface = first.surface;
    layout.secondBody = second.body;
    layout.means = std::move(means);
    return layout;
  };
  const auto axesOf = [&](const Side& side) -> Eigen::Matrix3d {
    if (!supported.axes)
      return Eigen::Matrix3d::Identity();
    return supported.axes(side.body, surfaceOf(terms, layoutOf(side), side.surface));
  };
  const bool isTied = terms.kind == scene::SurfaceContact::Kind::tied;
  Side first{terms.first, terms.firstSurface}, second{terms.second, terms.secondSurface};
  contact::ContactTerms asked{terms.name, first.surface, dimensionOf(layoutOf(first).mesh->cellType()),
                              components, terms.gap,     terms.distance};
  if (second.body < 0)
    return finish(
        meetObstacle(asked, nodesOf(terms, layoutOf(first), first.surface, 0), obstacleOf(terms.obstacle)),
        first, second, "nodes of '" + layoutOf(first).name + "'");
  if (terms.coupling != Coupling::mortar) {
    Side finer = first, other = second;
    if (orderOf(first) < orderOf(second)) // the side with more nodes has the rows
      std::swap(finer, other);
    const int order = orderOf(finer);
    asked.firstSurface = finer.surface;
    asked.sense = finer.body == first.body ? 1 : -1;
    asked.coincide = components == 1 && order == orderOf(other) && haveEqualEdges(terms, bodies);
    const contact::SurfaceNodes nodes = nodesOf(terms, layoutOf(finer), finer.surface, order),
                                facing = nodesOf(terms, layoutOf(other), other.surface, order);
    if (terms.coupling == Coupling::nodes || areAlike(asked, nodes, facing)) {
      const contact::FacingNodes pairs = facingNodes(asked, nodes, facing);
      return finish(isTied ? tieSurface(asked, nodes, facing, pairs, axesOf(finer))
                           : meetSurface(asked, nodes, facing, pairs),
                    finer, other, "pairs of nodes");
    }
  }
  asked.sense = terms.multipliers == scene::SurfaceContact::Side::second ? -1 : 1;
  if (asked.sense < 0)
    std::swap(first, second);
  asked.firstSurface = first.surface;
  const fem::Surface carrier = surfaceOf(terms, layoutOf(first), first.surface),
                     facing = surfaceOf(terms, layoutOf(second), second.surface);
  const contact::NodePoints ownPoints = pointsOf(layoutOf(first)), otherPoints = pointsOf(layoutOf(second));
  const contact::PlacedSurface own{carrier, ownPoints}, other{facing, otherPoints};
  const auto held = [&](GlobalOrdinal node, const Eigen::Vector3d& direction) {
    return supported.isHeld && supported.isHeld(first.body, node, direction);
  };
  return finish(isTied ? tieByMortar(asked, own, other, held, axesOf(first))
                       : meetByMortar(asked, own, other),
                first, second, "mortars on '" + layoutOf(first).name + "'");
}

SupportedNodes supportedNodes(const std::vector<std::unique_ptr<fem::BodyModel>>& models) {
  const auto modelOf = [&models](int body) -> const fem::BodyModel& {
    return *models[static_cast<std::size_t>(body)];
  };
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
  result.axes = [modelOf](int body, const fem::Surface& surface) {
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

SceneContacts layoutContacts(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                             const SupportedNodes& supported) {
  SceneContacts all;
  contact::KnownRows known;
  for (std::size_t number = 0; number < scene.contacts.size(); ++number) {
    requireSound(scene, number);
    scene::SurfaceContact terms = scene.contacts[number];
    const int components = componentsOf(scene.bodies[static_cast<std::size_t>(terms.first)].physics);
    std::string why = ", as asked";
    if (terms.second >= 0 && terms.multipliers == scene::SurfaceContact::Side::automatic)
      why = chooseSide(scene, bodies, terms);
    ContactLayout contact = layoutContact(terms, bodies, components, supported);
    contact.number = static_cast<int>(number);
    const bool hasMortars = !contact.firstShares.empty();
    if (hasMortars)
      contact.means += why;
    if (terms.kind == scene::SurfaceContact::Kind::tied) {
      all.ties.push_back(std::move(contact));
      continue;
    }
    known.dropFrom(contact);
    const fem::Surface surface =
        bodies[static_cast<std::size_t>(contact.firstBody)].mesh->surface(contact.firstSurface);
    hasMortars ? contact::smoothRows(surface, contact) : contact::adaptRows(surface, contact);
    all.contacts.push_back(std::move(contact));
  }
  for (auto* layouts : {&all.contacts, &all.ties}) {
    GlobalOrdinal firstRow = 0;
    for (ContactLayout& contact : *layouts) {
      contact.firstRow = firstRow;
      firstRow += contact.numRows();
    }
  }
  return all;
}

contact::ContactMatrix contactMatrix(const std::vector<BodyLayout>& bodies,
                                     const std::vector<ContactLayout>& contacts,
                                     const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                                     const RCP<const Comm>& comm) {
  contact::NodeUnknowns unknowns;
  unknowns.components = models.front()->components();
  unknowns.firstNode = firstNodes(bodies);
  const auto modelOf = [&](int body) -> const fem::BodyModel& {
    return *models[static_cast<std::size_t>(body)];
  };
  unknowns.frame = [&](int body, GlobalOrdinal node) { return modelOf(body).frame(node); };
  unknowns.isHeld = [&](int body, GlobalOrdinal node, int component) {
    return modelOf(body).prescribed(node, component).has_value();
  };
  unknowns.isMine = [&, share = shareOf(bodies, *comm)](int body, GlobalOrdinal node) {
    const BodyLayout& layout = bodies[static_cast<std::size_t>(body)];
    const int part = lowestPartAt(layout, node), lowest = layout.firstSubdomain + part;
    return part < layout.partition->numParts() && share.begin <= lowest && lowest < share.end;
  };
  return contact::contactMatrix(contacts, unknowns, comm);
}

} // namespace epafi::model
