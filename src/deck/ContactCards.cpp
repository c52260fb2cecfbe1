#include "epafi/deck/ContactCards.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::deck {
namespace {

using To = Reading::Reference::To;

Interaction& currentInteraction(Reading& reading, const Card& card) {
  if (reading.interaction == nullptr)
    card.refuse("it belongs behind a *SURFACE INTERACTION");
  return *reading.interaction;
}

/// The two surfaces of a line, the dependent one first.
std::pair<std::string, std::string> twoSurfaces(Reading& reading, const Card& card, const Line& line) {
  const Fields fields(card, line);
  fields.requireAtMost(2);
  std::pair<std::string, std::string> surfaces{fields.name(0, "a surface"),
                                               fields.name(1, "a second surface")};
  reading.refer(card, line.place(), To::surface, surfaces.first);
  reading.refer(card, line.place(), To::surface, surfaces.second);
  return surfaces;
}

void requireLines(const Card& card, const char* what) {
  if (card.data.empty())
    card.refuse("behind it belongs a line with " + std::string(what));
}

/// As one line, whose number is checked.
Fields onlyLine(const Card& card, const char* what) {
  requireLines(card, what);
  if (card.data.size() > 1)
    card.refuseAt(card.data[1].place(),
                  "one line with " + std::string(what) + " is enough; take this one out");
  return {card, card.data[0]};
}

double notNegative(const Fields& fields, int field, const char* what) {
  const double value = fields.real(field, what);
  if (value < 0)
    fields.refuse(std::string(what) + " should not be negative");
  return value;
}

} // namespace

void readInteraction(Reading& reading, const Card& card) {
  reading.interaction = &defined(card, card.required("NAME"), reading.deck.interactions);
}

void readSurfaceBehavior(Reading& reading, const Card& card) {
  Interaction& interaction = currentInteraction(reading, card);
  const std::string law = card.value("PRESSURE-OVERCLOSURE");
  if (law.empty() || law == "HARD") {
    interaction.law = Interaction::Law::hard;
    if (!card.data.empty() && card.value("PRESSURE-OVERCLOSURE").empty())
      card.refuse("its numbers need a PRESSURE-OVERCLOSURE=LINEAR or TIED");
    return;
  }
  if (law != "LINEAR" && law != "TIED")
    card.refuse("the pressure-overclosure " + shortened(law) + " is not known; write HARD, LINEAR or TIED");
  interaction.law = law == "LINEAR" ? Interaction::Law::linear : Interaction::Law::tied;
  const Fields fields = onlyLine(card, "the stiffness in front");
  interaction.stiffness = fields.real(0, "the stiffness, pressure per closure");
  if (interaction.stiffness <= 0)
    fields.refuse("the stiffness should be positive");
  if (fields.has(1))
    interaction.tension = notNegative(fields, 1, "the tension at large gaps");
  if (fields.has(2)) // c0, up to which gaps count as contact
    notNegative(fields, 2, "c0");
}

void readFriction(Reading& reading, const Card& card) {
  const Fields fields = onlyLine(card, "the coefficient of friction");
  const double friction = notNegative(fields, 0, "the coefficient of friction");
  std::optional<double> stickSlope;
  if (fields.has(1))
    stickSlope = notNegative(fields, 1, "the stick slope");
  if (!reading.isInStep) {
    Interaction& interaction = currentInteraction(reading, card);
    interaction.friction = friction;
    interaction.stickSlope = stickSlope;
    return;
  }
  if (!reading.awaitsFriction)
    card.refuse("in a step it belongs behind a *CHANGE FRICTION");
  reading.awaitsFriction = false;
  reading.step().frictions.back().friction = friction;
  reading.step().frictions.back().stickSlope = stickSlope;
}

void readContactPair(Reading& reading, const Card& card) {
  const std::string type = card.value("TYPE");
  if (!type.empty() && type != "NODETOSURFACE" && type != "SURFACETOSURFACE" && !type.ends_with("MORTAR"))
    card.refuse("TYPE=" + shortened(type) + " is not known; write NODE TO SURFACE or SURFACE TO SURFACE");
  ContactPair pair;
  pair.place = card.place;
  pair.interaction = card.required("INTERACTION");
  reading.refer(card, card.place, To::interaction, pair.interaction);
  pair.isSurfaceToSurface = !type.empty() && type != "NODETOSURFACE";
  if (card.has("ADJUST")) {
    pair.adjust = parsedReal(card.value("ADJUST"));
    if (!pair.adjust)
      pair.adjustSet = reading.nodeSet(card, "ADJUST");
    if (pair.adjust.value_or(0) < 0)
      card.refuse("ADJUST should not be negative");
  }
  requireLines(card, "the dependent (slave) and the independent (master) surface");
  for (const Line& line : card.data) {
    pair.place = line.place();
    std::tie(pair.dependent, pair.independent) = twoSurfaces(reading, card, line);
    reading.deck.contacts.push_back(pair);
  }
}

void readTie(Reading& reading, const Card& card) {
  Tie tie;
  tie.name = card.value("NAME");
  tie.tolerance = card.number("POSITIONTOLERANCE");
  requireLines(card, "the dependent (slave) and the independent (master) surface");
  for (const Line& line : card.data) {
    tie.place = line.place();
    std::tie(tie.dependent, tie.independent) = twoSurfaces(reading, card, line);
    reading.deck.ties.push_back(tie);
  }
}

void readPretension(Reading& reading, const Card& card) {
  Pretension pretension;
  pretension.place = card.place;
  pretension.surface = card.value("SURFACE");
  reading.refer(card, card.place, To::surface, pretension.surface);
  if (card.has("ELEMENT")) {
    pretension.element = parsedWhole(card.required("ELEMENT"));
    if (!pretension.element || reading.typeOf(*pretension.element) == nullptr)
      card.refuse("there is no element " + shortened(card.value("ELEMENT")));
  }
  if (pretension.surface.empty() == !pretension.element)
    card.refuse("it is of a SURFACE= or of an ELEMENT=; name one of them");
  const std::optional<GlobalOrdinal> node = parsedWhole(card.required("NODE"));
  if (!node || !reading.hasNode(*node))
    card.refuse("there is no node " + shortened(card.value("NODE")));
  pretension.node = *node;
  if (!card.data.empty()) {
    const Fields fields = onlyLine(card, "the bolt's direction");
    fields.requireAtMost(3);
    Point direction{};
    for (int i = 0; i < 3; ++i)
      direction[i] = fields.realOr(i, "a component of the direction", 0);
    if (!(std::hypot(direction[0], direction[1], direction[2]) > 0))
      fields.refuse("the direction is (0, 0, 0); name one, or leave the line out");
    pretension.direction = direction;
  }
  reading.deck.pretensions.push_back(std::move(pretension));
}

void readFrictionChange(Reading& reading, const Card& card) {
  const std::string name = card.required("INTERACTION");
  reading.refer(card, card.place, To::interaction, name);
  reading.step().frictions.push_back({card.place, name, 0, {}});
  reading.awaitsFriction = true;
}

void readModelChange(Reading& reading, const Card& card) {
  const bool isAdded = card.has("ADD");
  if (isAdded == card.has("REMOVE"))
    card.refuse("it needs ADD or REMOVE");
  requireLines(card, "the surfaces of a contact pair");
  for (const Line& line : card.data) {
    const auto [dependent, independent] = twoSurfaces(reading, card, line);
    const auto isPair = [&, dependent = dependent, independent = independent](const ContactPair& pair) {
      return pair.dependent == dependent && pair.independent == independent;
    };
    if (std::none_of(reading.deck.contacts.begin(), reading.deck.contacts.end(), isPair))
      card.refuseAt(line.place(), "there is no contact pair of the surfaces \"" + shortened(dependent) +
                                      "\" and \"" + shortened(independent) + '"');
    reading.step().pairs.push_back({line.place(), dependent, independent, isAdded});
  }
}

} // namespace epafi::deck
