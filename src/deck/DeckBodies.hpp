#pragma once

/// What of a deck hangs together.

#include "epafi/deck/Deck.hpp"
#include "epafi/deck/DeckElements.hpp"

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace epafi::deck {

/// Elements of one physics and order, joined facet by facet, but not across sections at which bolts are
/// tightened.
struct DeckBody {
  std::string name;                    ///< "body 1"
  const ElementForm* type = nullptr;   ///< of its first element, or of one that is integrated by fewer points
  Place place;                         ///< of the type's first card
  std::vector<GlobalOrdinal> elements; ///< their numbers, ascending
  std::vector<GlobalOrdinal> nodes;    ///< likewise
};

class DeckBodies {
public:
  /// Keeps a reference. \throws InputError for element types that Epafi has not, elements without a section,
  /// elements of the plane beside others, or other kinds of them
  explicit DeckBodies(const Deck& deck);

  [[nodiscard]] const std::vector<DeckBody>& all() const { return bodies_; }
  /// What an element is.
  [[nodiscard]] const ElementForm& typeOf(GlobalOrdinal element) const { return *typeOf_.at(element); }
  /// The body of an element.
  [[nodiscard]] int ofElement(GlobalOrdinal element) const { return bodyOfElement_.at(element); }
  /// Those that have a node, ascending; none of a node without elements.
  [[nodiscard]] const std::vector<int>& ofNode(GlobalOrdinal node) const;
  /// All nodes of an element.
  [[nodiscard]] std::span<const GlobalOrdinal> nodesOf(GlobalOrdinal element) const {
    return nodesOf_.at(element);
  }
  /// Corners of a face of an element. Precondition: it has the face, S1 being 1.
  [[nodiscard]] std::vector<GlobalOrdinal> cornersOf(const std::pair<GlobalOrdinal, int>& face) const;
  /// These and the nodes between them.
  [[nodiscard]] std::vector<GlobalOrdinal> nodesOfFace(const std::pair<GlobalOrdinal, int>& face) const;
  /// Section of an element, as its place in Deck::sections.
  [[nodiscard]] int sectionOf(GlobalOrdinal element) const { return sectionOf_.at(element); }

private:
  void findSections(const Deck& deck);
  /// \param alike  all elements of which some may be in one body
  void addBodies(const Deck& deck, const std::vector<const Elements*>& alike);

  std::vector<DeckBody> bodies_;
  std::map<GlobalOrdinal, int> bodyOfElement_, sectionOf_;
  std::map<GlobalOrdinal, const ElementForm*> typeOf_;
  std::map<GlobalOrdinal, std::vector<int>> bodiesOfNode_;
  std::map<GlobalOrdinal, std::span<const GlobalOrdinal>> nodesOf_;
};

} // namespace epafi::deck
