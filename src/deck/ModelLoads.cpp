#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <Teuchos_Array.hpp>

#include <algorithm>
#include <array>

namespace epafi::deck {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

/// What cards say of things of one kind as steps go by: a card replaces what earlier steps say of a thing,
/// and adds to what its own step says.
template <class Key, class Card>
class History {
public:
  void beginStep(bool isNew) {
    if (isNew)
      cards_.clear();
    isOfStep_.clear();
  }
  void add(const Key& key, const Card* card) {
    std::vector<const Card*>& own = cards_[key];
    if (!isOfStep_[key])
      own.clear();
    isOfStep_[key] = true;
    own.push_back(card);
  }
  [[nodiscard]] const std::map<Key, std::vector<const Card*>>& all() const { return cards_; }

private:
  std::map<Key, std::vector<const Card*>> cards_;
  std::map<Key, bool> isOfStep_;
};

Array<double> firstOf(const Eigen::Vector3d& vector, int dimension) {
  return {vector.data(), vector.data() + dimension};
}

/// Face of P1 … P6; 0: the load is none on a face.
int faceOf(const DistributedLoad& load) {
  return load.label.size() == 2 && load.label[0] == 'P' ? load.label[1] - '0' : 0;
}

/// The one that a node stands for; null: it is a node as others are.
const Coupling* couplingAt(const Deck& deck, GlobalOrdinal node) {
  const auto found = std::find_if(deck.couplings.begin(), deck.couplings.end(),
                                  [&](const Coupling& coupling) { return coupling.node == node; });
  return found == deck.couplings.end() ? nullptr : &*found;
}

[[noreturn]] void refuse(const Place& place, const std::string& what) {
  throw InputError(text(place) + ": " + what);
}

} // namespace

double ModelMaker::factorAt(const std::string& amplitude, double delay, std::size_t step) const {
  if (amplitude.empty())
    return 1;
  const Amplitude& curve = deck_.amplitudes.at(amplitude);
  double time = deck_.steps[step].period - delay;
  for (std::size_t k = 0; curve.isOfTotalTime && k < step; ++k)
    time += deck_.steps[k].period;
  if (curve.isSquareOfTime)
    return time * time;
  const auto& points = curve.points;
  const auto behind = // of two values at one time the later one holds
      std::find_if(points.begin(), points.end(), [&](const auto& point) { return point.first > time; });
  if (behind == points.begin() || behind == points.end())
    return behind == points.end() ? points.back().second : points.front().second;
  const auto& before = *(behind - 1);
  return before.second +
         (behind->second - before.second) * (time - before.first) / (behind->first - before.first);
}

ModelMaker::Prescribed ModelMaker::prescribed() const {
  History<std::pair<GlobalOrdinal, int>, Boundary> history;
  Prescribed result;
  const auto take = [&](const std::vector<Boundary>& boundaries) {
    for (const Boundary& boundary : boundaries)
      for (const GlobalOrdinal node : boundary.nodes)
        for (int c = boundary.first - 1; c < boundary.last; ++c) {
          history.beginStep(false); // the last card holds
          history.add({node, c}, &boundary);
        }
  };
  take(deck_.boundaries);
  for (std::size_t k = 0; k < deck_.steps.size(); ++k) {
    history.beginStep(deck_.steps[k].newBoundaries);
    take(deck_.steps[k].boundaries);
    for (const auto& [key, cards] : history.all()) {
      const Boundary& card = *cards.back();
      if (card.isFixed && k == 0)
        refuse(card.place, "*BOUNDARY: FIXED holds what a step before has moved, and there is none");
      std::vector<Hold>& holds = result[key];
      holds.resize(k); // free till now
      holds.push_back(
          {true, card.isFixed, card.isFixed ? 0 : card.value * factorAt(card.amplitude, card.delay, k)});
    }
  }
  for (auto& [key, holds] : result)
    holds.resize(deck_.steps.size());
  return result;
}

void ModelMaker::addSupports() {
  // Nodes with the same values in the same axes.
  std::map<std::tuple<int, int, int, std::vector<Hold>>, Numbers> groups; // by body, transform, component
  for (const auto& [key, holds] : prescribed()) {
    const auto transform = transformOf_.find(key.first);
    for (const int body : bodies_.ofNode(key.first))
      groups[{body, transform == transformOf_.end() ? -1 : transform->second, key.second, holds}].push_back(
          key.first);
  }
  for (const auto& [key, nodes] : groups) {
    const auto& [body, transform, component, holds] = key;
    if (component >= bodies_.all()[body].type->dimension)
      continue;
    const std::string name = "support " + std::to_string(listOf(body).sublist("Supports").numParams() + 1);
    ParameterList& list = listOf(body).sublist("Supports").sublist(name);
    list.set("Surface", placeNamed(body, bodies_.all()[body].name + ' ' + name, nodes));
    const auto first =
        std::find_if(holds.begin(), holds.end(), [](const Hold& hold) { return hold.value != 0; });
    const double base = first == holds.end() ? 0 : first->value;
    const bool changes = std::any_of(holds.begin(), holds.end(),
                                     [](const Hold& hold) { return !hold.isHeld || hold.isFixed; });
    list.set(std::string(1, "XYZ"[component]), base);
    if (transform >= 0) {
      const Transform& axes = deck_.transforms[transform];
      list.set(axes.isCylindrical ? "Cylinder" : "Axes",
               Array<double>({axes.a[0], axes.a[1], axes.a[2], axes.b[0], axes.b[1], axes.b[2]}));
    }
    for (std::size_t k = 0; (base != 0 || changes) && k < holds.size(); ++k)
      supportFactors_[k] += bodies_.all()[body].name + '/' + name + " = " +
                            (!holds[k].isHeld   ? "off"
                             : holds[k].isFixed ? "fixed"
                                                : valueText(base == 0 ? 1 : holds[k].value / base)) +
                            ", ";
  }
}

ParameterList& ModelMaker::addLoad(int body, std::size_t step, const std::string& kind) {
  ParameterList& loads = listOf(body).sublist("Loads");
  const std::string name =
      "step " + std::to_string(step + 1) + " load " + std::to_string(loads.numParams() + 1);
  for (std::size_t k = 0; k < loadFactors_.size(); ++k)
    loadFactors_[k] += bodies_.all()[body].name + '/' + name + (k == step ? " = 1, " : " = 0, ");
  ParameterList& load = loads.sublist(name);
  load.set("Kind", kind);
  return load;
}

void ModelMaker::addForces(std::size_t step) {
  History<std::pair<GlobalOrdinal, int>, NodeForce> history;
  for (std::size_t k = 0; k <= step; ++k) {
    history.beginStep(deck_.steps[k].newForces);
    for (const NodeForce& force : deck_.steps[k].forces)
      for (const GlobalOrdinal node : force.nodes)
        history.add({node, force.component - 1}, &force);
  }
  NodeForces forces;
  std::map<const Coupling*, SpreadForce> spread;
  for (const auto& [key, cards] : history.all())
    for (const NodeForce* card : cards) {
      const double size = card->value * factorAt(card->amplitude, card->delay, step);
      if (const auto tension = tensions_.find(key.first); tension != tensions_.end() && key.second == 0) {
        tension->second[step] += size;
        continue;
      }
      if (const Coupling* const coupling = couplingAt(deck_, key.first)) {
        SpreadForce& own = spread[coupling];
        (key.second < 3 ? own.force : own.moment) += size * axesOf(key.first).col(key.second % 3);
        continue;
      }
      if (bodies_.ofNode(key.first).empty())
        refuse(card->place, "*CLOAD: node " + std::to_string(key.first) +
                                " belongs to no element; a force on it is not solved here");
      forces.try_emplace(key.first, Eigen::Vector3d::Zero()).first->second +=
          size * axesOf(key.first).col(key.second);
    }
  shareOut(spread, step, forces);
  std::map<std::pair<int, std::array<double, 3>>, Numbers> groups; // nodes with the same force
  for (const auto& [node, force] : forces)
    if (!force.isZero(0))
      groups[{bodies_.ofNode(node).front(), {force[0], force[1], force[2]}}].push_back(node);
  for (const auto& [key, nodes] : groups) {
    ParameterList& load = addLoad(key.first, step, "point");
    load.set("Surface",
             nodesNamed("loaded " + std::to_string(nodes.front()) + " with " +
                            std::to_string(nodes.size() - 1) + " more of step " + std::to_string(step + 1),
                        nodes));
    load.set("Force", firstOf(Eigen::Map<const Eigen::Vector3d>(key.second.data()),
                              bodies_.all()[key.first].type->dimension));
  }
}

/// What nodes take that stand for others becomes loads on surfaces, or forces of these others.
void ModelMaker::shareOut(const std::map<const Coupling*, SpreadForce>& spread, std::size_t step,
                          NodeForces& forces) {
  for (const auto& [coupling, own] : spread) {
    if (!coupling->surface.empty())
      addSpreadForce(*coupling, own, step);
    else if (!own.moment.isZero(0))
      refuse(coupling->place,
             "*DISTRIBUTING COUPLING: it passes on forces alone, and there is a moment; write "
             "*COUPLING and *DISTRIBUTING");
    for (const auto& [node, weight] : coupling->weights) {
      if (bodies_.ofNode(node).empty())
        refuse(coupling->place, "*DISTRIBUTING COUPLING: node " + std::to_string(node) +
                                    " belongs to no element; leave it out");
      forces.try_emplace(node, Eigen::Vector3d::Zero()).first->second += weight * own.force;
    }
  }
}

void ModelMaker::addSpreadForce(const Coupling& coupling, const SpreadForce& spread, std::size_t step) {
  const std::set<int> bodies = bodiesAt(coupling.surface, nullptr);
  if (bodies.size() > 1)
    refuse(coupling.place,
           "*COUPLING: its surface is of several bodies, between which it is not known how the "
           "force is shared; give each a node of its own");
  const ElementForm& type = *bodies_.all()[*bodies.begin()].type;
  const bool isPlane = type.dimension == 2;
  if ((isPlane && (spread.moment.head<2>() != Eigen::Vector2d::Zero() || spread.force.z() != 0)) ||
      (isOfRevolution(type) && (!spread.moment.isZero(0) || spread.force.x() != 0)))
    refuse(coupling.place,
           "*COUPLING: a force or moment on its node leads out of what the elements can carry");
  ParameterList& load = addLoad(*bodies.begin(), step, "distributed");
  load.set("Surface", coupling.surface);
  load.set("Force", firstOf(spread.force, type.dimension));
  if (isOfRevolution(type))
    return;
  load.set("Moment", isPlane ? Array<double>(1, spread.moment.z()) : firstOf(spread.moment, 3));
  load.set("Point",
           firstOf(Eigen::Map<const Eigen::Vector3d>(pointOf(coupling.node).data()), type.dimension));
}

void ModelMaker::addPressures(std::size_t step) {
  History<std::pair<GlobalOrdinal, int>, DistributedLoad> history; // by element and face
  for (std::size_t k = 0; k <= step; ++k) {
    history.beginStep(deck_.steps[k].newDistributedLoads);
    for (const DistributedLoad& load : deck_.steps[k].loads)
      if (!load.surface.empty())
        for (const auto& face : deck_.surfaces.at(load.surface).faces)
          history.add(face, &load);
      else if (const int face = faceOf(load); face > 0)
        for (const GlobalOrdinal element : load.elements)
          history.add({element, face}, &load);
      else if (load.label != "GRAV" && load.label != "CENTRIF")
        refuse(load.place, "*DLOAD: loads of the kind " + load.label +
                               " are not solved here; there are P1 … P6, GRAV and CENTRIF");
  }
  std::map<std::pair<int, double>, std::vector<std::pair<GlobalOrdinal, int>>> groups; // of the same pressure
  for (const auto& [face, cards] : history.all()) {
    double pressure = 0;
    for (const DistributedLoad* card : cards)
      pressure += card->values.at(0) * factorAt(card->amplitude, card->delay, step);
    if (pressure != 0)
      groups[{bodies_.ofElement(face.first), pressure}].push_back(face);
  }
  for (const auto& [key, faces] : groups) {
    ParameterList& load = addLoad(key.first, step, "pressure");
    const std::string name = "pressed " + std::to_string(model_.groups.surfaces.size() + 1);
    model_.groups.surfaces[name] = faces;
    load.set("Surface", name);
    load.set("Value", key.second);
  }
}

void ModelMaker::addBodyForces(std::size_t step) {
  // By elements, label, and direction or axis: only what is alike in these is replaced.
  History<std::tuple<Numbers, std::string, std::vector<double>>, DistributedLoad> history;
  for (std::size_t k = 0; k <= step; ++k) {
    history.beginStep(deck_.steps[k].newDistributedLoads);
    for (const DistributedLoad& load : deck_.steps[k].loads)
      if (load.label == "GRAV" || load.label == "CENTRIF")
        history.add({load.elements, load.label, {load.values.begin() + 1, load.values.end()}}, &load);
  }
  std::map<std::tuple<int, int, const DistributedLoad*>, Numbers> groups; // by body and section
  for (const auto& [key, cards] : history.all())
    for (const DistributedLoad* card : cards)
      for (const GlobalOrdinal element : card->elements)
        groups[{bodies_.ofElement(element), bodies_.sectionOf(element), card}].push_back(element);
  for (const auto& [key, elements] : groups) {
    const auto& [body, section, card] = key;
    const Material& material = deck_.materials.at(deck_.sections[section].material);
    if (!material.density)
      refuse(card->place, "*DLOAD: " + card->label + " needs the *DENSITY of the material " +
                              deck_.sections[section].material);
    const double size = *material.density * card->values.at(0) * factorAt(card->amplitude, card->delay, step);
    const ElementForm& type = *bodies_.all()[body].type;
    const int dimension = type.dimension;
    ParameterList& load = addLoad(body, step, card->label == "GRAV" ? "body" : "rotation");
    if (elements != bodies_.all()[body].elements)
      load.set("Group",
               elementsNamed("loaded elements " + std::to_string(elementNames_.size() + 1), elements));
    const auto vector = [&values = card->values](std::size_t first) {
      return Eigen::Vector3d(values.at(first), values.at(first + 1), values.at(first + 2));
    };
    if (card->label == "GRAV") {
      if (isOfRevolution(type) && (vector(1).x() != 0 || vector(1).z() != 0))
        refuse(card->place, "*DLOAD: GRAV: solids of revolution are pulled along their axis, y, alone");
      load.set("Force", firstOf(size * vector(1).normalized(), dimension));
      continue;
    }
    load.set("Value", size);
    if (isOfRevolution(type)) {
      if (vector(1).x() != 0 || vector(1).z() != 0 || vector(4).x() != 0 || vector(4).z() != 0)
        refuse(card->place, "*DLOAD: CENTRIF: solids of revolution turn about their axis, y");
      continue;
    }
    load.set("Point", firstOf(vector(1), dimension));
    if (dimension == 3)
      load.set("Axis", firstOf(vector(4), 3));
    else if (vector(4).head<2>() != Eigen::Vector2d::Zero())
      refuse(card->place, "*DLOAD: CENTRIF: plane bodies turn about an axis across their plane");
  }
}

void ModelMaker::addSteps() {
  addSupports();
  for (std::size_t k = 0; k < deck_.steps.size(); ++k) {
    addForces(k);
    addPressures(k);
    addBodyForces(k);
    addTemperatures(k);
  }
  if (deck_.steps.size() == 1)
    return;
  for (std::size_t k = 0; k < deck_.steps.size(); ++k) {
    ParameterList& step = model_.scene.sublist("Steps").sublist("step " + std::to_string(k + 1));
    step.set("Loads", loadFactors_[k]);
    step.set("Supports", supportFactors_[k]);
  }
}

} // namespace epafi::deck
