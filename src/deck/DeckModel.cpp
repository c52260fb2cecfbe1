#include "epafi/deck/DeckModel.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/deck/DeckSections.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <Eigen/Geometry>
#include <Teuchos_Array.hpp>

#include <algorithm>
#include <numbers>

namespace epafi::deck {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

/// First and second local axis of a rectangular system.
std::vector<double> localAxesOf(const Orientation& orientation) {
  if (orientation.isCylindrical)
    throw InputError(text(orientation.place) +
                     ": *ORIENTATION: a cylindrical system of a material is not "
                     "solved here; cut the body into sectors with rectangular ones");
  using Eigen::Vector3d;
  const Vector3d a = Eigen::Map<const Vector3d>(orientation.a.data()).normalized(),
                 third = a.cross(Eigen::Map<const Vector3d>(orientation.b.data())).normalized();
  Eigen::Matrix3d axes;
  axes << a, third.cross(a), third;
  if (orientation.rotationAxis > 0)
    axes = axes * Eigen::AngleAxisd(orientation.rotationAngle * std::numbers::pi / 180,
                                    Vector3d::Unit(orientation.rotationAxis - 1));
  return {axes(0, 0), axes(1, 0), axes(2, 0), axes(0, 1), axes(1, 1), axes(2, 1)};
}

void refuseUnsolved(const Deck& deck) {
  if (deck.steps.empty())
    throw InputError(deck.file + " has no *STEP; there is nothing to solve");
  for (const Step& step : deck.steps)
    if (step.isPerturbation && deck.steps.size() > 1)
      throw InputError(text(step.place) +
                       ": *STEP: a step of PERTURBATION among others is not solved here; make it "
                       "a deck of its own");
}

} // namespace

ModelMaker::ModelMaker(const Deck& deck, std::string mesh)
    : deck_(deck), mesh_(std::move(mesh)), bodies_(deck) {
  refuseUnsolved(deck);
  loadFactors_.resize(deck.steps.size());
  supportFactors_.resize(deck.steps.size());
  for (const Pretension& pretension : deck.pretensions)
    tensions_[pretension.node].resize(deck.steps.size());
  for (int t = 0; t < std::ssize(deck.transforms); ++t)
    for (const GlobalOrdinal node : deck.transforms[t].nodes)
      transformOf_[node] = t;
  model_.scene.set("Title", deck.title.empty() ? deck.file : deck.title);
  for (const Step& step : deck.steps)
    if (step.isNonlinear) {
      model_.notes.push_back(text(step.place) +
                             ": NLGEOM: displacements are taken to be small; if strains or rotations turn "
                             "out to be above a fifth the run ends with code 1");
      model_.scene.sublist("Accuracy").set("Small Displacements", true);
      break;
    }
  for (const auto& [name, amplitude] : deck.amplitudes)
    if (amplitude.isSquareOfTime)
      model_.notes.push_back(text(amplitude.place) + ": *AMPLITUDE, USER: " + name +
                             " is the square of time, as CalculiX is delivered");
  for (const Ignored& ignored : deck.ignored)
    model_.notes.push_back(text(ignored.place) + ": " + ignored.keyword + " is passed over");
}

ParameterList& ModelMaker::listOf(int body) {
  return model_.scene.sublist("Bodies").sublist(bodies_.all()[body].name);
}

std::string ModelMaker::nodesNamed(const std::string& name, Numbers nodes) {
  const auto [place, isNew] = nodeNames_.try_emplace(nodes, name);
  if (isNew)
    model_.groups.nodes[name] = std::move(nodes);
  return place->second;
}

std::string ModelMaker::placeNamed(int body, const std::string& name, const Numbers& nodes) {
  std::map<Numbers, std::vector<Face>> facesAt; // by corners: those of one element alone are on the surface
  const auto isNamed = [&](GlobalOrdinal node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  };
  for (const GlobalOrdinal element : bodies_.all()[body].elements)
    for (int label = 1; label <= std::ssize(bodies_.typeOf(element).faces); ++label) {
      Numbers corners = bodies_.cornersOf({element, label});
      if (!std::all_of(corners.begin(), corners.end(), isNamed))
        continue;
      std::sort(corners.begin(), corners.end());
      facesAt[corners].emplace_back(element, label);
    }
  std::vector<Face> faces;
  std::set<GlobalOrdinal> left(nodes.begin(), nodes.end());
  for (const auto& [corners, at] : facesAt) {
    const Numbers all = bodies_.nodesOfFace(at.front());
    if (at.size() > 1 || !std::all_of(all.begin(), all.end(), isNamed))
      continue;
    faces.push_back(at.front());
    for (const GlobalOrdinal node : all)
      left.erase(node);
  }
  if (!left.empty())
    return nodesNamed(name, nodes);
  std::sort(faces.begin(), faces.end());
  const auto [place, isNew] = faceNames_.try_emplace(faces, name);
  if (isNew)
    model_.groups.surfaces[name] = faces;
  return place->second;
}

std::string ModelMaker::elementsNamed(const std::string& name, Numbers elements) {
  const auto [place, isNew] = elementNames_.try_emplace(elements, name);
  if (isNew)
    model_.groups.elements[name] = std::move(elements);
  return place->second;
}

void ModelMaker::checkPrints() {
  const bool isPlane = bodies_.all().front().type->dimension == 2;
  for (const Step& step : deck_.steps)
    for (const Print& print : step.prints)
      if (print.of == Print::Of::elements && isPlane)
        model_.notes.push_back(text(print.place) +
                               ": *EL PRINT is of solids alone here; --frd has stresses at nodes");
      else if (print.of == Print::Of::section && !sectionAt(deck_, bodies_, deck_.surfaces.at(print.set)))
        model_.notes.push_back(text(print.place) + ": *SECTION PRINT: " + print.set +
                               " is no surface of faces that parts a solid, or bounds it; passed over");
}

void ModelMaker::addBodies() {
  for (int b = 0; b < std::ssize(bodies_.all()); ++b) {
    const DeckBody& body = bodies_.all()[b];
    ParameterList& list = listOf(b);
    list.set("Physics", body.type->physics);
    list.set("Mesh", mesh_);
    list.set("Group", body.name);
    model_.groups.elements[body.name] = body.elements;
    model_.nodeNumbers.push_back(body.nodes);
    model_.elementNumbers.push_back(body.elements);
    list.set("Inner Nodes", "none");
    if (isOfRevolution(*body.type))
      list.set("Axis", "free"); // what is to be held the deck says
    if (body.type->isReduced && (body.elements.size() > 1 || !body.type->isLooseAlone()))
      list.set("Integration", "reduced");
    else if (body.type->isReduced)
      model_.notes.push_back(text(body.place) + ": element " + std::to_string(body.elements.front()) +
                             " stands alone and is integrated fully: reduced, it would be loose in itself");
    std::map<int, Numbers> elementsOf; // by section
    for (const GlobalOrdinal element : body.elements)
      elementsOf[bodies_.sectionOf(element)].push_back(element);
    bool isRegion = false;
    for (const auto& [section, elements] : elementsOf) {
      ParameterList* own = &list;
      if (isRegion) {
        std::string name = deck_.sections[section].elementSet;
        if (model_.groups.elements.contains(name))
          name += " of " + body.name; // each body has its own part
        own = &list.sublist("Regions").sublist(name);
        own->set("Group", elementsNamed(name, elements));
      }
      addMaterial(*own, deck_.sections[section], b);
      isRegion = true;
    }
    addStiffnessFactors(b);
  }
}

void ModelMaker::addMaterial(ParameterList& list, const Section& section, int body) {
  const Material& material = deck_.materials.at(section.material);
  if (!material.elastic)
    throw InputError(text(material.place) + ": *MATERIAL: " + section.material +
                     " has no *ELASTIC; bodies are linearly elastic here");
  const std::vector<double> constants = constantsOf(material, body);
  const ElementForm& type = *bodies_.all().front().type;
  if (type.dimension == 2 && !isOfRevolution(type))
    list.set("Thickness", section.thickness.value_or(1.0));
  setExpansion(list, material);
  if (material.elastic->kind == ElasticConstants::Kind::isotropic) {
    list.set("Young's Modulus", constants.at(0));
    list.set("Poisson's Ratio", constants.at(1));
    return;
  }
  list.set("Elasticity", Array<double>(constants));
  if (!section.orientation.empty())
    list.set("Axes", Array<double>(localAxesOf(deck_.orientations.at(section.orientation))));
}

bool isDeck(const std::string& file) {
  return file.ends_with(".inp") || file.ends_with(".inp.gz");
}

DeckModel modelOf(const Deck& deck, const std::string& mesh) {
  ModelMaker maker(deck, mesh);
  maker.checkPrints();
  maker.addBodies();
  maker.addSteps();
  maker.addPretensions();
  maker.addEquations();
  maker.addContacts();
  return maker.take();
}

} // namespace epafi::deck
