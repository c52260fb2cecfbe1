#include "epafi/model/SceneContacts.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/ContactSearch.hpp"
#include "epafi/contact/KnownRows.hpp"
#include "epafi/contact/QuadraticFaces.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <algorithm>
#include <string>

namespace epafi::model {
namespace {

using contact::ContactLayout;

/// A side of a contact.
struct Side {
  int body;
  std::string surface;
};

/// The nodes of a side. \param order  of the facets between them, at least
contact::SurfaceNodes nodesOf(const scene::SurfaceContact& contact, const BodyLayout& body,
                              const std::string& surface, int order) {
  const std::vector<std::string> names = body.mesh->surfaceNames();
  if (std::find(names.begin(), names.end(), surface) == names.end()) {
    std::string known;
    for (const std::string& name : names)
      known += (known.empty() ? "'" : ", '") + name + "'";
    throw InputError("contact '" + contact.name + "': body '" + body.name + "' has no surface '" + surface +
                     "'; " + (known.empty() ? "its mesh names none" : "there are " + known));
  }
  return contact::surfaceNodes(*body.mesh, body.mesh->surface(surface), order);
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
                            int components) {
  const auto layoutOf = [&](const Side& side) -> const BodyLayout& {
    return bodies[static_cast<std::size_t>(side.body)];
  };
  const auto orderOf = [&](const Side& side) { return fem::orderOf(layoutOf(side).mesh->cellType()); };
  Side first{terms.first, terms.firstSurface}, second{terms.second, terms.secondSurface};
  if (second.body >= 0 && orderOf(first) < orderOf(second)) // the side with more nodes has the rows
    std::swap(first, second);
  const int order = orderOf(first);
  const contact::SurfaceNodes nodes = nodesOf(terms, layoutOf(first), first.surface, order);
  contact::ContactTerms asked{terms.name, first.surface, dimensionOf(layoutOf(first).mesh->cellType()),
                              components, terms.gap,     terms.distance};
  ContactLayout layout;
  if (second.body < 0) {
    layout = meetObstacle(asked, nodes, obstacleOf(terms.obstacle));
  } else {
    asked.coincide = components == 1 && order == orderOf(second) &&
                     layoutOf(first).mesh->structured() != nullptr &&
                     layoutOf(second).mesh->structured() != nullptr;
    layout = meetSurface(asked, nodes, nodesOf(terms, layoutOf(second), second.surface, order));
  }
  layout.firstBody = first.body;
  layout.firstSurface = first.surface;
  layout.secondBody = second.body;
  return layout;
}

std::vector<ContactLayout> layoutContacts(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) {
  std::vector<ContactLayout> contacts;
  contact::KnownRows known;
  for (std::size_t number = 0; number < scene.contacts.size(); ++number) {
    requireSound(scene, number);
    const scene::SurfaceContact& terms = scene.contacts[number];
    const int components = componentsOf(scene.bodies[static_cast<std::size_t>(terms.first)].physics);
    ContactLayout& contact = contacts.emplace_back(layoutContact(terms, bodies, components));
    known.dropFrom(contact);
    const fem::Mesh& mesh = *bodies[static_cast<std::size_t>(contact.firstBody)].mesh;
    contact::adaptRows(mesh.surface(contact.firstSurface), contact);
  }
  GlobalOrdinal firstRow = 0;
  for (ContactLayout& contact : contacts) {
    contact.firstRow = firstRow;
    firstRow += contact.numRows();
  }
  return contacts;
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
    const int lowest = layout.firstSubdomain + lowestPartAt(layout, node);
    return share.begin <= lowest && lowest < share.end;
  };
  return contact::contactMatrix(contacts, unknowns, comm);
}

} // namespace epafi::model
