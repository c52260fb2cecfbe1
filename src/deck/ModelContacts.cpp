#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>

namespace epafi::deck {
namespace {

/// Share of an element's size up to which *TIE bonds nodes if it does not say how far, as CalculiX has it.
constexpr double usualTolerance = 0.025;

} // namespace

/// ∫n over a face of flat elements, out of its element.
Eigen::Vector3d ModelMaker::areaVectorOf(const Face& face) const {
  using Eigen::Vector3d;
  const auto at = [&](GlobalOrdinal node) {
    return Vector3d(Eigen::Map<const Vector3d>(pointOf(node).data()));
  };
  const Numbers corners = bodies_.cornersOf(face);
  Vector3d centre(0, 0, 0), area(0, 0, 0);
  for (const GlobalOrdinal node : bodies_.nodesOf(face.first))
    centre += at(node) / static_cast<double>(bodies_.nodesOf(face.first).size());
  const Vector3d first = at(corners[0]), along = at(corners[1]) - first;
  area = Vector3d(along.y(), -along.x(), 0);
  if (corners.size() > 2)
    area = 0.5 * along.cross(at(corners[2]) - first);
  if (corners.size() > 3)
    area += 0.5 * (at(corners[2]) - first).cross(at(corners[3]) - first);
  return area.dot(first - centre) < 0 ? Vector3d(-area) : area;
}

/// Faces of one element alone all of whose corners are among some nodes; at nodes that have none of them
/// those that look against a direction. \throws InputError if a node is in none of either
std::vector<ModelMaker::Face> ModelMaker::facesAt(const Surface& surface, const std::string& name,
                                                  const Eigen::Vector3d& against) const {
  std::map<Numbers, std::vector<Face>> facesOf; // by corners, ascending
  const auto isNamed = [&](GlobalOrdinal node) {
    return std::binary_search(surface.nodes.begin(), surface.nodes.end(), node);
  };
  for (const DeckBody& body : bodies_.all())
    for (const GlobalOrdinal element : body.elements)
      for (int label = 1; label <= std::ssize(bodies_.typeOf(element).faces); ++label) {
        Numbers corners = bodies_.cornersOf({element, label});
        std::sort(corners.begin(), corners.end());
        if (std::any_of(corners.begin(), corners.end(), isNamed))
          facesOf[corners].emplace_back(element, label);
      }
  std::erase_if(facesOf, [](const auto& at) { return at.second.size() > 1; });
  std::vector<Face> faces;
  std::set<GlobalOrdinal> bare(surface.nodes.begin(), surface.nodes.end());
  const auto add = [&](const Face& face) {
    faces.push_back(face);
    for (const GlobalOrdinal node : bodies_.nodesOf(face.first))
      bare.erase(node);
  };
  for (const auto& [corners, at] : facesOf)
    if (std::all_of(corners.begin(), corners.end(), isNamed))
      add(at.front());
  const std::set<GlobalOrdinal> left = bare;
  for (const auto& [corners, at] : facesOf) {
    constexpr double clearly = 0.7;
    const Eigen::Vector3d area = areaVectorOf(at.front());
    if (std::any_of(corners.begin(), corners.end(),
                    [&](GlobalOrdinal node) { return left.contains(node); }) &&
        area.dot(against) < -clearly * area.norm() * against.norm())
      add(at.front());
  }
  if (!bare.empty())
    throw InputError(
        text(surface.place) + ": *SURFACE: node " + std::to_string(*bare.begin()) + " of " + name +
        " belongs to no face of an element that has all its corners in it, or looks at the other "
        "surface; define the surface by the elements' faces");
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// Bodies that have faces of a surface; the mesh has it under its name. \param facing  the surface that it
/// faces; null: none is known
std::set<int> ModelMaker::bodiesAt(const std::string& surface, const Surface* facing) {
  const Surface& given = deck_.surfaces.at(surface);
  Eigen::Vector3d against(0, 0, 0);
  if (given.ofNodes && facing != nullptr)
    for (const Face& face : facing->faces)
      against += areaVectorOf(face);
  std::vector<Face>& faces = model_.groups.surfaces[surface];
  faces = given.ofNodes ? facesAt(given, surface, against) : given.faces;
  std::set<int> bodies;
  for (const Face& face : faces)
    bodies.insert(bodies_.ofElement(face.first));
  return bodies;
}

/// Mean length of the first edges of a surface's faces. Precondition: bodiesAt() has found them.
double ModelMaker::typicalSize(const std::string& surface) const {
  const std::vector<Face>& faces = model_.groups.surfaces.at(surface);
  double sum = 0;
  for (const Face& face : faces) {
    const Numbers corners = bodies_.cornersOf(face);
    const Point &a = pointOf(corners[0]), &b = pointOf(corners[1]);
    sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  return sum / static_cast<double>(faces.size());
}

/// Whether a set has all corners of a surface's faces.
bool ModelMaker::hasNodesOf(const std::string& set, const std::string& surface) const {
  const Numbers& nodes = deck_.nodeSets.at(set);
  const std::vector<Face>& faces = model_.groups.surfaces.at(surface);
  return std::all_of(faces.begin(), faces.end(), [&](const Face& face) {
    const Numbers corners = bodies_.cornersOf(face);
    return std::all_of(corners.begin(), corners.end(), [&](GlobalOrdinal node) {
      return std::binary_search(nodes.begin(), nodes.end(), node);
    });
  });
}

/// A list for each two bodies that have faces of two surfaces, under names of their own; these.
std::vector<std::string> ModelMaker::addPairs(const std::string& name, const std::string& dependent,
                                              const std::string& independent, const Place& place) {
  Teuchos::ParameterList& contacts = model_.scene.sublist("Contact");
  const std::set<int> first = bodiesAt(dependent, &deck_.surfaces.at(independent)),
                      second = bodiesAt(independent, nullptr);
  std::vector<std::string> names;
  for (const int body : first)
    for (const int other : second) {
      if (body == other)
        throw InputError(text(place) + ": " + name +
                         ": both surfaces are of one body, which cannot touch itself here");
      std::string own = name;
      for (int number = 2; contacts.isSublist(own); ++number)
        own = name + ' ' + std::to_string(number);
      Teuchos::ParameterList& pair = contacts.sublist(own);
      pair.set("First Body", bodies_.all()[body].name);
      pair.set("First Surface", dependent);
      pair.set("Second Body", bodies_.all()[other].name);
      pair.set("Second Surface", independent);
      names.push_back(own);
    }
  return names;
}

void ModelMaker::addContactPair(const ContactPair& pair) {
  const Interaction& interaction = deck_.interactions.at(pair.interaction);
  const bool isTied = interaction.law == Interaction::Law::tied;
  if (isTied && interaction.stickSlope.value_or(0) == 0)
    throw InputError(text(interaction.place) + ": *SURFACE BEHAVIOR: TIED needs a stick slope, the second "
                                               "number of *FRICTION; give it one");
  if (isTied && !pair.adjust && pair.adjustSet.empty())
    model_.notes.push_back(text(pair.place) + ": *CONTACT PAIR: what lies between tied surfaces stays");
  if (!pair.isSurfaceToSurface)
    model_.notes.push_back(text(pair.place) + ": *CONTACT PAIR: surfaces meet surface to surface here");
  if (interaction.tension.value_or(0) > 0 && contactsOf_[pair.interaction].empty())
    model_.notes.push_back(text(interaction.place) +
                           ": *SURFACE BEHAVIOR: the tension at large gaps is left out");
  for (const std::string& name :
       addPairs(pair.dependent + " - " + pair.independent, pair.dependent, pair.independent, pair.place)) {
    contactsBetween_[{pair.dependent, pair.independent}].push_back(name);
    Teuchos::ParameterList& list = model_.scene.sublist("Contact").sublist(name);
    if (interaction.law != Interaction::Law::hard)
      list.set("Stiffness", interaction.stiffness);
    if (isTied) {
      list.set("Kind", "tied");
      list.set("Stick Slope", *interaction.stickSlope);
      continue;
    }
    contactsOf_[pair.interaction].push_back(name);
    if (interaction.friction > 0)
      list.set("Friction", interaction.friction);
    if (interaction.friction > 0 && interaction.stickSlope.value_or(0) > 0)
      list.set("Stick Slope", *interaction.stickSlope);
    constexpr double whatever = 1e30;
    if (pair.adjust || (!pair.adjustSet.empty() && hasNodesOf(pair.adjustSet, pair.dependent)))
      list.set("Adjust", pair.adjust.value_or(whatever));
    else if (!pair.adjustSet.empty())
      list.set("Adjust Nodes", nodesNamed(pair.adjustSet, deck_.nodeSets.at(pair.adjustSet)));
  }
}

void ModelMaker::addContacts() {
  for (const ContactPair& pair : deck_.contacts)
    addContactPair(pair);
  changeFriction();
  changePairs();
  for (const Tie& tie : deck_.ties)
    for (const std::string& name :
         addPairs(tie.name.empty() ? "tie" : tie.name, tie.dependent, tie.independent, tie.place)) {
      Teuchos::ParameterList& list = model_.scene.sublist("Contact").sublist(name);
      list.set("Kind", "tied");
      list.set("Distance", tie.tolerance.value_or(usualTolerance * typicalSize(tie.dependent)));
    }
}

void ModelMaker::changeFriction() {
  for (std::size_t k = 0; k < deck_.steps.size(); ++k) {
    std::string coefficients;
    for (const FrictionChange& change : deck_.steps[k].frictions) {
      const Interaction& interaction = deck_.interactions.at(change.interaction);
      if (change.stickSlope.value_or(0) != interaction.stickSlope.value_or(0) || interaction.friction == 0 ||
          change.friction == 0)
        throw InputError(text(change.place) +
                         ": *CHANGE FRICTION: a coefficient greater than 0 may change to another, "
                         "but the stick slope stays as it is");
      for (const std::string& contact : contactsOf_[change.interaction]) {
        coefficients += contact + " = " + valueText(change.friction) + ", ";
        if (deck_.steps.size() == 1)
          model_.scene.sublist("Contact").sublist(contact).set("Friction", change.friction);
      }
    }
    if (!coefficients.empty() && deck_.steps.size() > 1)
      model_.scene.sublist("Steps").sublist("step " + std::to_string(k + 1)).set("Friction", coefficients);
  }
}

void ModelMaker::changePairs() {
  for (std::size_t k = 0; k < deck_.steps.size(); ++k) {
    std::string states;
    for (const PairChange& change : deck_.steps[k].pairs)
      for (const std::string& contact : contactsBetween_.at({change.dependent, change.independent}))
        states += contact + (change.isAdded ? " = on, " : " = off, ");
    if (!states.empty())
      model_.scene.sublist("Steps").sublist("step " + std::to_string(k + 1)).set("Contacts", states);
  }
}

} // namespace epafi::deck
