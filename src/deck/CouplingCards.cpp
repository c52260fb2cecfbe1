#include "epafi/base/Errors.hpp"
#include "epafi/deck/ConditionCards.hpp"

#include <algorithm>

namespace epafi::deck {
namespace {

Coupling& addCoupling(Reading& reading, const Card& card, GlobalOrdinal node) {
  for (const Coupling& other : reading.deck.couplings)
    if (other.node == node)
      card.refuse("node " + std::to_string(node) + " stands for other nodes already, since " +
                  text(other.place) + "; take another one");
  return reading.deck.couplings.emplace_back(Coupling{card.place, node, "", {}});
}

} // namespace

bool isCoupling(const std::string& elementType) {
  return elementType == "DCOUP3D";
}

void readCoupling(Reading& reading, const Card& card) {
  const std::string number = card.required("REFNODE");
  const std::optional<GlobalOrdinal> node = parsedWhole(number);
  if (!node || !reading.hasNode(*node))
    card.refuse("REF NODE=" + shortened(number) + " is no node of the deck");
  Coupling& coupling = addCoupling(reading, card, *node);
  coupling.surface = card.required("SURFACE");
  reading.refer(card, card.place, Reading::Reference::To::surface, coupling.surface);
  reading.awaitsDistributing = true;
}

/// All forces and moments are passed on, whatever components are listed.
void readDistributing(Reading& reading, const Card& card) {
  if (!reading.awaitsDistributing)
    card.refuse("it belongs behind *COUPLING, which names a node and a surface");
  reading.awaitsDistributing = false;
}

void readDistributingCoupling(Reading& reading, const Card& card) {
  const std::string set = reading.elementSet(card, "ELSET");
  const std::vector<GlobalOrdinal>& elements = reading.deck.elementSets[set];
  const auto element =
      elements.size() == 1 ? reading.couplingNodes.find(elements.front()) : reading.couplingNodes.end();
  if (element == reading.couplingNodes.end())
    card.refuse("ELSET=" + shortened(set) + " should be one element of type DCOUP3D");
  Coupling& coupling = addCoupling(reading, card, element->second);
  double sum = 0;
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    fields.requireAtMost(2);
    const double weight = fields.realOr(1, "a weight", 1);
    if (weight < 0)
      fields.refuse("a weight should not be negative");
    for (const GlobalOrdinal node : reading.nodes(fields, 0)) {
      coupling.weights[node] += weight;
      sum += weight;
    }
  }
  if (sum == 0)
    card.refuse("behind it belong nodes and their weights, which should not all be 0");
  for (auto& [node, weight] : coupling.weights)
    weight /= sum;
}

} // namespace epafi::deck
