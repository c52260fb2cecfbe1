#include "epafi/deck/DeckModel.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <Eigen/Geometry>
#include <Teuchos_Array.hpp>

#include <algorithm>
#include <numbers>
#include <set>

namespace epafi::deck {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

/// The constants of the one row that there is, or all elements have the temperature of.
std::vector<double> constantsOf(const ElasticConstants& elastic, const Deck& deck, const Place& place) {
  std::set<double> temperatures;
  for (const Temperature& initial : deck.initialTemperatures)
    temperatures.insert(initial.value);
  const auto& rows = elastic.rows;
  if (rows.size() == 1)
    return rows.front().constants;
  if (temperatures.size() != 1)
    throw InputError(text(place) +
                     ": *ELASTIC: constants for several temperatures need one initial temperature "
                     "of all nodes here; give those of one temperature");
  const double at = *temperatures.begin();
  const auto above =
      std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.temperature >= at; });
  if (above == rows.begin() || above == rows.end())
    return above == rows.end() ? rows.back().constants : rows.front().constants;
  const auto& below = *(above - 1);
  const double share = (at - below.temperature) / (above->temperature - below.temperature);
  std::vector<double> constants(below.constants);
  for (std::size_t i = 0; i < constants.size(); ++i)
    constants[i] += share * (above->constants[i] - constants[i]);
  return constants;
}

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

/// Strain of temperatures is none of what is solved here.
void requireNoThermalStrain(const Deck& deck) {
  const bool expands = std::any_of(deck.materials.begin(), deck.materials.end(),
                                   [](const auto& entry) { return entry.second.expansion.has_value(); });
  for (const Step& step : deck.steps)
    for (const Temperature& temperature : step.temperatures)
      if (expands)
        throw InputError(text(temperature.place) +
                         ": *TEMPERATURE: strain of temperatures is not solved here; "
                         "take the temperatures or the *EXPANSION out");
}

void refuseUnsolved(const Deck& deck) {
  if (deck.steps.empty())
    throw InputError(deck.file + " has no *STEP; there is nothing to solve");
  if (!deck.pretensions.empty())
    throw InputError(
        text(deck.pretensions.front().place) +
        ": *PRE-TENSION SECTION: bolts are not tightened here yet; give the section's ends forces");
  requireNoThermalStrain(deck);
}

} // namespace

ModelMaker::ModelMaker(const Deck& deck, std::string mesh)
    : deck_(deck), mesh_(std::move(mesh)), bodies_(deck) {
  refuseUnsolved(deck);
  loadFactors_.resize(deck.steps.size());
  supportFactors_.resize(deck.steps.size());
  for (int t = 0; t < std::ssize(deck.transforms); ++t)
    for (const GlobalOrdinal node : deck.transforms[t].nodes)
      transformOf_[node] = t;
  model_.scene.set("Title", deck.title.empty() ? deck.file : deck.title);
  for (const Step& step : deck.steps)
    if (step.isNonlinear) {
      model_.notes.push_back(text(step.place) +
                             ": NLGEOM: displacements are small here: the linear problem is solved");
      break;
    }
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

std::string ModelMaker::elementsNamed(const std::string& name, Numbers elements) {
  const auto [place, isNew] = elementNames_.try_emplace(elements, name);
  if (isNew)
    model_.groups.elements[name] = std::move(elements);
  return place->second;
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
    if (body.type->isReduced)
      list.set("Integration", "reduced");
    std::map<int, Numbers> elementsOf; // by section
    for (const GlobalOrdinal element : body.elements)
      elementsOf[bodies_.sectionOf(element)].push_back(element);
    bool isRegion = false;
    for (const auto& [section, elements] : elementsOf) {
      ParameterList* own = &list;
      if (isRegion) {
        const std::string name = deck_.sections[section].elementSet;
        own = &list.sublist("Regions").sublist(name);
        own->set("Group", elementsNamed(name, elements));
      }
      addMaterial(*own, deck_.sections[section], isRegion);
      isRegion = true;
    }
  }
}

void ModelMaker::addMaterial(ParameterList& list, const Section& section, bool /*isRegion*/) {
  const Material& material = deck_.materials.at(section.material);
  if (!material.elastic)
    throw InputError(text(material.place) + ": *MATERIAL: " + section.material +
                     " has no *ELASTIC; bodies are linearly elastic here");
  const std::vector<double> constants = constantsOf(*material.elastic, deck_, material.place);
  const ElementForm& type = *bodies_.all().front().type;
  if (type.dimension == 2 && !isOfRevolution(type))
    list.set("Thickness", section.thickness.value_or(1.0));
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
  maker.addBodies();
  maker.addSteps();
  maker.addEquations();
  maker.addContacts();
  return maker.take();
}

} // namespace epafi::deck
