#include "epafi/deck/MeshCards.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/deck/ConditionCards.hpp"

#include <algorithm>
#include <map>

namespace epafi::deck {
namespace {

void readNodeCard(const Card& card, std::vector<std::pair<GlobalOrdinal, Point>>& nodes,
                  std::vector<GlobalOrdinal>* set) {
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    fields.requireAtMost(7); // the last three are Abaqus' normal, of use for shells
    const GlobalOrdinal number = fields.number(0, "a node");
    Point point{};
    for (int i = 0; i < 3; ++i)
      point[i] = fields.realOr(1 + i, "a coordinate", 0);
    nodes.emplace_back(number, point);
    if (set != nullptr)
      set->push_back(number);
  }
}

/// An element as it stands in a card.
struct WrittenElement {
  GlobalOrdinal number;
  const Card* card;
  const Line* line;
  std::vector<GlobalOrdinal> nodes;
};

/// The elements of a card; the nodes of one may go on over several lines.
void readElementCard(const Reading& reading, const Card& card, int numNodes,
                     std::vector<WrittenElement>& elements) {
  bool isComplete = true;
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    int field = 0;
    if (isComplete && fields.size() > 0)
      elements.push_back({fields.number(field++, "an element"), &card, &line, {}});
    for (; field < fields.size(); ++field) {
      if (std::ssize(elements.back().nodes) == numNodes)
        fields.refuse("element " + std::to_string(elements.back().number) + " has more than the " +
                      std::to_string(numNodes) + " nodes of its type");
      elements.back().nodes.push_back(reading.node(fields, field));
    }
    isComplete = elements.empty() || std::ssize(elements.back().nodes) == numNodes;
  }
  if (!isComplete)
    card.refuseAt(elements.back().line->place(), "element " + std::to_string(elements.back().number) +
                                                     " has " + std::to_string(elements.back().nodes.size()) +
                                                     " nodes where its type has " + std::to_string(numNodes));
}

/// Sorted, of one definition a number; the same element twice is one.
void sortElements(std::vector<WrittenElement>& elements) {
  std::stable_sort(elements.begin(), elements.end(),
                   [](const auto& a, const auto& b) { return a.number < b.number; });
  const auto isTwice = [](const WrittenElement& a, const WrittenElement& b) {
    if (a.number == b.number && a.nodes != b.nodes)
      b.card->refuseAt(b.line->place(), "element " + std::to_string(b.number) + " is defined in " +
                                            text(a.line->place()) +
                                            " with other nodes; number them differently");
    return a.number == b.number;
  };
  elements.erase(std::unique(elements.begin(), elements.end(), isTwice), elements.end());
}

Elements asElements(const std::string& type, int numNodes, const Place& place,
                    const std::vector<WrittenElement>& written) {
  Elements elements{type, numNodes, {}, {}, place};
  for (const WrittenElement& element : written) {
    elements.numbers.push_back(element.number);
    elements.nodes.insert(elements.nodes.end(), element.nodes.begin(), element.nodes.end());
  }
  return elements;
}

/// Numbers and sets of a line of *NSET or *ELSET. \param defined  all numbers that there are, ascending
void addMembers(const Fields& fields, const Sets& sets, const std::vector<GlobalOrdinal>& defined,
                const char* what, std::vector<GlobalOrdinal>& members) {
  for (int i = 0; i < fields.size(); ++i) {
    if (!fields.has(i))
      continue;
    if (parsedWhole(fields[i])) {
      const GlobalOrdinal number = fields.number(i, what);
      if (!std::binary_search(defined.begin(), defined.end(), number))
        fields.refuse("the deck does not define " +
                      std::string(what).substr(std::string(what).find(' ') + 1) + ' ' +
                      std::to_string(number));
      members.push_back(number);
      continue;
    }
    const std::string name = fields.name(i, what);
    const auto found = sets.find(name);
    if (found == sets.end())
      fields.refuse("there is no set \"" + shortened(name) + "\" by here; define it before");
    members.insert(members.end(), found->second.begin(), found->second.end());
  }
}

/// "first, last, increment"; numbers that are not defined are left out.
void addRange(const Fields& fields, const std::vector<GlobalOrdinal>& defined, const char* what,
              std::vector<GlobalOrdinal>& members) {
  fields.requireAtMost(3);
  const GlobalOrdinal first = fields.number(0, what);
  const GlobalOrdinal last = fields.has(1) ? fields.number(1, what) : first;
  const GlobalOrdinal increment = fields.has(2) ? fields.number(2, "the increment") : 1;
  if (last < first)
    fields.refuse("the range ends at " + std::to_string(last) + ", before it begins at " +
                  std::to_string(first));
  for (auto number = std::lower_bound(defined.begin(), defined.end(), first);
       number != defined.end() && *number <= last; ++number)
    if ((*number - first) % increment == 0)
      members.push_back(*number);
}

void readSet(Reading& reading, const Card& card, const std::string& parameter, Sets& sets,
             const std::vector<GlobalOrdinal>& defined) {
  const std::string name = card.required(parameter);
  const char* const what = parameter == "NSET" ? "a node" : "an element";
  std::vector<GlobalOrdinal> members = sets[name];
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    const std::size_t before = members.size();
    if (card.has("GENERATE"))
      addRange(fields, defined, what, members);
    else
      addMembers(fields, sets, defined, what, members);
    reading.count(card, members.size() - before);
  }
  sortUnique(members);
  sets[name] = std::move(members);
}

} // namespace

void readNodes(Reading& reading, const std::vector<Card>& cards) {
  std::vector<std::pair<GlobalOrdinal, Point>> nodes;
  for (const Card& card : cards)
    if (card.keyword == "NODE")
      readNodeCard(card, nodes, card.has("NSET") ? &reading.deck.nodeSets[card.required("NSET")] : nullptr);
  for (auto& [name, numbers] : reading.deck.nodeSets)
    sortUnique(numbers);
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (i + 1 == nodes.size() || nodes[i + 1].first != nodes[i].first) { // the last definition holds
      reading.deck.nodes.numbers.push_back(nodes[i].first);
      reading.deck.nodes.points.push_back(nodes[i].second);
    }
}

void readElements(Reading& reading, const std::vector<Card>& cards) {
  std::map<std::string, std::pair<Place, std::vector<WrittenElement>>> types;
  for (const Card& card : cards) {
    if (card.keyword != "ELEMENT")
      continue;
    const std::string type = card.required("TYPE");
    std::vector<WrittenElement> couplings;
    auto& elements =
        isCoupling(type)
            ? couplings
            : types.try_emplace(type, card.place, std::vector<WrittenElement>()).first->second.second;
    const std::size_t before = elements.size();
    readElementCard(reading, card, isCoupling(type) ? 1 : findElementType(type)->numNodes, elements);
    for (const WrittenElement& element : couplings)
      reading.couplingNodes[element.number] = element.nodes.front();
    if (card.has("ELSET")) {
      std::vector<GlobalOrdinal>& set = reading.deck.elementSets[card.required("ELSET")];
      for (std::size_t i = before; i < elements.size(); ++i)
        set.push_back(elements[i].number);
    }
  }
  for (auto& [name, numbers] : reading.deck.elementSets)
    sortUnique(numbers);
  for (auto& [type, written] : types) {
    sortElements(written.second);
    const int index = static_cast<int>(reading.deck.elements.size());
    for (const WrittenElement& element : written.second)
      reading.elements.emplace_back(element.number, index);
    reading.deck.elements.push_back(
        asElements(type, findElementType(type)->numNodes, written.first, written.second));
  }
  std::sort(reading.elements.begin(), reading.elements.end());
  for (std::size_t i = 1; i < reading.elements.size(); ++i)
    if (reading.elements[i].first == reading.elements[i - 1].first) {
      const Elements& type = reading.deck.elements[reading.elements[i].second];
      throw InputError(text(type.place) + ": *ELEMENT, TYPE=" + type.type + ": element " +
                       std::to_string(reading.elements[i].first) + " is also one of type " +
                       reading.deck.elements[reading.elements[i - 1].second].type +
                       "; number them differently.");
    }
}

void readSets(Reading& reading, const std::vector<Card>& cards) {
  std::vector<GlobalOrdinal> elements;
  for (const auto& [number, type] : reading.elements)
    elements.push_back(number);
  for (const Card& card : cards)
    if (card.keyword == "NSET")
      readSet(reading, card, "NSET", reading.deck.nodeSets, reading.deck.nodes.numbers);
    else if (card.keyword == "ELSET")
      readSet(reading, card, "ELSET", reading.deck.elementSets, elements);
}

} // namespace epafi::deck
