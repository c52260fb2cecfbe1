/// Any bytes as an input deck: it is read, what it refers to is there, and it becomes a scene with a mesh; or
/// it is refused in a sentence.

#include "Refusals.hpp"

#include "epafi/deck/DeckModel.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

using namespace epafi;

void require(bool holds) {
  if (!holds)
    std::abort();
}

void requireNodes(const deck::Deck& deck, const std::vector<GlobalOrdinal>& nodes) {
  for (const GlobalOrdinal node : nodes)
    require(std::binary_search(deck.nodes.numbers.begin(), deck.nodes.numbers.end(), node));
}

/// What others count on.
void use(const deck::Deck& deck) {
  require(std::adjacent_find(deck.nodes.numbers.begin(), deck.nodes.numbers.end(), std::greater_equal<>()) ==
          deck.nodes.numbers.end());
  for (const deck::Elements& elements : deck.elements) {
    require(std::ssize(elements.nodes) == std::ssize(elements.numbers) * elements.nodesPerElement);
    requireNodes(deck, elements.nodes);
  }
  for (const auto& [name, set] : deck.nodeSets)
    requireNodes(deck, set);
  for (const deck::Section& section : deck.sections)
    require(deck.elementSets.contains(section.elementSet) && deck.materials.contains(section.material));
  for (const deck::Step& step : deck.steps)
    for (const deck::Print& print : step.prints) {
      using Of = deck::Print::Of;
      require(print.of != Of::nodes || deck.nodeSets.contains(print.set));
      require(print.of != Of::elements || deck.elementSets.contains(print.set));
      require(print.of != Of::section || deck.surfaces.contains(print.set));
    }
  for (const deck::Step& step : deck.steps)
    for (const deck::Boundary& boundary : step.boundaries) {
      require(boundary.first >= 1 && boundary.first <= boundary.last && boundary.last <= 3);
      requireNodes(deck, boundary.nodes);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::orRefused([&] {
    const deck::Deck deck = deck::parseDeck(text, "deck.inp");
    use(deck);
    (void)mshText(deck, deck::modelOf(deck, "deck.inp").groups);
  });
  return 0;
}
