#include "epafi/deck/ConditionCards.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <map>

namespace epafi::deck {
namespace {

/// AMPLITUDE= and TIME DELAY= of the card.
struct Timing {
  std::string amplitude;
  double delay = 0;
};

Timing timingOf(Reading& reading, const Card& card) {
  Timing timing{card.value("AMPLITUDE"), card.number("TIMEDELAY").value_or(0)};
  reading.refer(card, card.place, Reading::Reference::To::amplitude, timing.amplitude);
  if (timing.delay < 0)
    card.refuse("TIME DELAY should not be negative");
  return timing;
}

/// OP=NEW.
bool isNew(const Card& card) {
  const std::string op = card.value("OP");
  if (!op.empty() && op != "NEW" && op != "MOD")
    card.refuse("OP=" + shortened(op) + " is neither NEW nor MOD");
  return op == "NEW";
}

/// Components of Abaqus' names for symmetry and the like, or {0, 0}.
std::pair<int, int> namedComponents(const std::string& name) {
  static const std::map<std::string, std::pair<int, int>> components{
      {"XSYMM", {1, 1}}, {"YSYMM", {2, 2}}, {"ZSYMM", {3, 3}}, {"PINNED", {1, 3}}, {"ENCASTRE", {1, 3}}};
  const auto found = components.find(name);
  return found == components.end() ? std::pair(0, 0) : found->second;
}

constexpr int lastRotation = 6;

/// Components of displacements; {4, ...} if it is one of rotations alone, which nodes of solids do not have.
std::pair<int, int> componentsOf(const Fields& fields) {
  const std::pair<int, int> named = namedComponents(squeezed(fields[1]));
  if (named.first > 0)
    return named;
  const int first = fields.integer(1, "a component, 1 ... 3");
  const int last = fields.has(2) ? fields.integer(2, "the last component, 1 ... 3") : first;
  if (first < 1 || last < first || last > lastRotation)
    fields.refuse("it prescribes the components " + std::to_string(first) + " ... " + std::to_string(last) +
                  ", and displacements have those of 1 ... 3" +
                  (first == 11 ? "; temperatures are prescribed by *TEMPERATURE" : ""));
  return {first, first > 3 ? last : std::min(last, 3)};
}

bool standsForOthers(const Deck& deck, GlobalOrdinal node) {
  return std::any_of(deck.couplings.begin(), deck.couplings.end(),
                     [&](const Coupling& coupling) { return coupling.node == node; });
}

int forceComponent(const Deck& deck, const Fields& fields, const std::vector<GlobalOrdinal>& nodes) {
  const int component = fields.integer(1, "a component, 1 ... 3");
  const auto mayTurn = [&](GlobalOrdinal node) { return standsForOthers(deck, node); };
  const bool isMoment =
      component > 3 && component <= lastRotation && std::all_of(nodes.begin(), nodes.end(), mayTurn);
  if (!isMoment && (component < 1 || component > 3))
    fields.refuse(
        "its component is " + std::to_string(component) +
        ", and forces on nodes have those of 1 ... 3 (bodies are solids, whose nodes take no moments)");
  return component;
}

} // namespace

void readBoundary(Reading& reading, const Card& card) {
  const Timing timing = timingOf(reading, card);
  const bool replaces = isNew(card);
  if (reading.isInStep && replaces)
    reading.step().newBoundaries = true;
  std::vector<Boundary>& boundaries = reading.isInStep ? reading.step().boundaries : reading.deck.boundaries;
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    fields.requireAtMost(4);
    const auto [first, last] = componentsOf(fields);
    const double value = fields.realOr(3, "a displacement", 0);
    std::vector<GlobalOrdinal> nodes = reading.nodes(fields, 0);
    for (const GlobalOrdinal node : nodes)
      if (standsForOthers(reading.deck, node))
        fields.refuse("node " + std::to_string(node) +
                      " stands for others, and passes forces on alone; hold these nodes themselves");
    if (first <= 3)
      boundaries.push_back({line.place(), std::move(nodes), first, last, value, timing.amplitude,
                            card.has("FIXED"), timing.delay});
    else if (value == 0)
      reading.ignore(card.shown + " of rotations", line.place());
    else
      fields.refuse("it prescribes a rotation, and the nodes of solids have none");
  }
}

void readNodeForce(Reading& reading, const Card& card) {
  const Timing timing = timingOf(reading, card);
  reading.step().newForces |= isNew(card);
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    fields.requireAtMost(3);
    std::vector<GlobalOrdinal> nodes = reading.nodes(fields, 0);
    const int component = forceComponent(reading.deck, fields, nodes);
    const double value = fields.real(2, "a force");
    reading.step().forces.push_back(
        {line.place(), std::move(nodes), component, value, timing.amplitude, timing.delay});
  }
}

void readElementLoad(Reading& reading, const Card& card) {
  const Timing timing = timingOf(reading, card);
  reading.step().newDistributedLoads |= isNew(card);
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    const std::string label = fields.name(1, "a label, such as P1");
    const bool isPressure = label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6';
    if (!isPressure && label != "GRAV" && label != "CENTRIF")
      throw InputError(
          asSentence(text(line.place()) + ": " + card.shown + ' ' + shortened(label) +
                     ": the loads that are read are P1 ... P6, GRAV and CENTRIF; write it as one of "
                     "these"));
    const int numValues = isPressure ? 1 : label == "GRAV" ? 4 : 7;
    fields.requireAtMost(2 + numValues);
    std::vector<double> values;
    for (int i = 0; i < numValues; ++i)
      values.push_back(i == 0 ? fields.real(2, "the load's value") : fields.realOr(2 + i, "a number", 0));
    const auto firstOfDirection = values.end() - std::min(3, numValues - 1);
    if (!isPressure && std::all_of(firstOfDirection, values.end(), [](double value) { return value == 0; }))
      fields.refuse("its direction is (0, 0, 0)");
    std::vector<GlobalOrdinal> elements = reading.elementsIn(fields, 0);
    for (const GlobalOrdinal element : elements)
      if (isPressure && label[1] - '0' > findElementType(reading.typeOf(element)->type)->numFaces)
        fields.refuse("element " + std::to_string(element) + " of type " + reading.typeOf(element)->type +
                      " has no face for " + label);
    reading.step().loads.push_back(
        {line.place(), std::move(elements), label, std::move(values), timing.amplitude, "", timing.delay});
  }
}

void readSurfaceLoad(Reading& reading, const Card& card) {
  const Timing timing = timingOf(reading, card);
  reading.step().newDistributedLoads |= isNew(card);
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    fields.requireAtMost(3);
    const std::string surface = fields.name(0, "a surface"), label = fields.name(1, "the label P");
    if (label != "P")
      fields.refuse("the load \"" + shortened(label) + "\" is not read; of surfaces there is P, a pressure");
    reading.refer(card, line.place(), Reading::Reference::To::surface, surface);
    reading.step().loads.push_back(
        {line.place(), {}, label, {fields.real(2, "the pressure")}, timing.amplitude, surface, timing.delay});
  }
}

void readTemperature(Reading& reading, const Card& card) {
  const Timing timing = timingOf(reading, card);
  reading.step().newTemperatures |= isNew(card);
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    fields.requireAtMost(2);
    const double value = fields.real(1, "a temperature");
    reading.step().temperatures.push_back(
        {line.place(), reading.nodes(fields, 0), value, timing.amplitude, timing.delay});
  }
}

void readInitialConditions(Reading& reading, const Card& card) {
  if (card.required("TYPE") != "TEMPERATURE")
    card.refuse("TYPE=" + shortened(card.value("TYPE")) + " is not known; write TYPE=TEMPERATURE");
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    fields.requireAtMost(2);
    const double value = fields.real(1, "a temperature");
    reading.deck.initialTemperatures.push_back({line.place(), reading.nodes(fields, 0), value, "", 0});
  }
}

} // namespace epafi::deck
