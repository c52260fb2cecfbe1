#pragma once

/// A deck on its way from cards to values: what is known so far, and what cards name.

#include "epafi/deck/Cards.hpp"
#include "epafi/deck/Deck.hpp"
#include "epafi/deck/Fields.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace epafi::deck {

/// Of a type of element that is read.
struct ElementType {
  const char* name;
  int numNodes, numFaces;
};

/// Null if there is none.
const ElementType* findElementType(const std::string& name);
std::vector<std::string> elementTypeNames();

struct Reading {
  Deck deck;
  std::vector<std::pair<GlobalOrdinal, int>> elements; ///< number and index into deck.elements, ascending

  Material* material = nullptr;       ///< that property cards are of
  Interaction* interaction = nullptr; ///< likewise
  bool isInStep = false, hasProcedure = false, isNonlinear = false, awaitsFriction = false,
       awaitsDistributing = false;
  std::map<GlobalOrdinal, GlobalOrdinal> couplingNodes; ///< of elements DCOUP3D

  /// References to what may be defined later.
  struct Reference {
    enum class To { material, orientation, surface, interaction, amplitude };
    const Card* card;
    Place place;
    To to;
    std::string name;
  };
  std::vector<Reference> references;

  Step& step() { return deck.steps.back(); }
  void refer(const Card& card, const Place& place, Reference::To to, const std::string& name);
  void checkReferences() const; ///< \throws InputError of the first one that does not hold

  [[nodiscard]] bool hasNode(GlobalOrdinal number) const;
  [[nodiscard]] const Elements* typeOf(GlobalOrdinal element) const; ///< null if it is not defined

  GlobalOrdinal node(const Fields& fields, int field) const;
  /// The node, or those of the set, that the field names.
  std::vector<GlobalOrdinal> nodes(const Fields& fields, int field);
  std::vector<GlobalOrdinal> elementsIn(const Fields& fields, int field); ///< likewise
  /// The name of the card's parameter, which is a set.
  std::string nodeSet(const Card& card, std::string_view parameter) const;
  std::string elementSet(const Card& card, std::string_view parameter) const;
  /// Counts numbers that are copied from sets. \throws InputError  if they are more than memory should hold
  void count(const Card& card, std::size_t numbers);

  void ignore(const std::string& keyword, const Place& place); ///< names it once

private:
  std::size_t counted_ = 0;
};

[[noreturn]] void refuseTwice(const Card& card, const std::string& name, const Place& place);

/// A new thing of that name, with the card's place. \throws InputError if there is one already
template <class Things>
auto& defined(const Card& card, const std::string& name, Things& things) {
  const auto [found, isNew] = things.try_emplace(name);
  if (!isNew)
    refuseTwice(card, name, found->second.place);
  found->second.place = card.place;
  return found->second;
}

} // namespace epafi::deck
