#include "epafi/deck/DeckMesh.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/deck/DeckElements.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <sstream>

namespace epafi::deck {
namespace {

using Numbers = std::vector<GlobalOrdinal>;

/// One element, facet or node of the mesh file.
struct Cell {
  GlobalOrdinal number = 0;
  Numbers nodes;
};

/// Cells of one kind that are in the same groups: an entity of the file.
struct Entity {
  std::vector<int> groups; ///< physical numbers
  int kind = 0;
  std::vector<Cell> cells;
};

constexpr int pointKind = 15;

/// Entities of one dimension, by kind and groups.
class Entities {
public:
  void name(int group, const std::string& name) { names_.emplace_back(group, name); }
  void add(std::vector<int> groups, int kind, Cell cell) {
    auto [place, isNew] = places_.try_emplace({kind, groups}, all_.size());
    if (isNew)
      all_.push_back({std::move(groups), kind, {}});
    all_[place->second].cells.push_back(std::move(cell));
  }
  [[nodiscard]] const std::vector<Entity>& all() const { return all_; }
  [[nodiscard]] const std::vector<std::pair<int, std::string>>& names() const { return names_; }

private:
  std::map<std::pair<int, std::vector<int>>, std::size_t> places_;
  std::vector<Entity> all_;
  std::vector<std::pair<int, std::string>> names_;
};

/// The groups of each number.
template <class Key>
std::map<Key, std::vector<int>> groupsOf(const std::map<std::string, std::vector<Key>>& named,
                                         Entities& entities) {
  std::map<Key, std::vector<int>> groups;
  int number = 0;
  for (const auto& [name, members] : named) {
    entities.name(++number, name);
    for (const Key& member : members)
      groups[member].push_back(number);
  }
  return groups;
}

class MshWriter {
public:
  MshWriter(const Deck& deck, const MeshGroups& groups) : deck_(deck) {
    addElements(groups);
    addFacets(groups);
    addNodes(groups);
  }
  [[nodiscard]] std::string text() const;

private:
  void addElements(const MeshGroups& groups);
  void addFacets(const MeshGroups& groups);
  void addNodes(const MeshGroups& groups);
  void requireInPlane(const Elements& elements, const Cell& cell) const;
  [[nodiscard]] const Point& pointOf(GlobalOrdinal node) const {
    const Numbers& numbers = deck_.nodes.numbers;
    return deck_.nodes.points[std::lower_bound(numbers.begin(), numbers.end(), node) - numbers.begin()];
  }
  void writeNames(std::ostream& out) const;
  void writeEntities(std::ostream& out) const;
  void writeNodes(std::ostream& out) const;
  void writeElements(std::ostream& out) const;

  const Deck& deck_;
  int dimension_ = 0;
  GlobalOrdinal lastNumber_ = 0; ///< of an element or facet
  std::array<Entities, 4> entities_;
  std::set<GlobalOrdinal> nodes_; ///< of the elements
};

void MshWriter::addElements(const MeshGroups& groups) {
  std::array<Entities, 1> names;
  const auto groupsOfElement = groupsOf(groups.elements, names[0]);
  for (const Elements& elements : deck_.elements) {
    const std::size_t count = elements.nodesPerElement;
    for (std::size_t e = 0; e < elements.numbers.size(); ++e) {
      const auto own = groupsOfElement.find(elements.numbers[e]);
      if (own == groupsOfElement.end())
        continue;
      const ElementForm& type = formOf(elements);
      dimension_ = type.dimension;
      Cell cell{elements.numbers[e], {}};
      for (const int place : type.places)
        cell.nodes.push_back(elements.nodes[e * count + place]);
      nodes_.insert(cell.nodes.begin(), cell.nodes.end());
      lastNumber_ = std::max(lastNumber_, cell.number);
      if (dimension_ == 2)
        requireInPlane(elements, cell);
      names[0].add(own->second, type.kind, std::move(cell));
    }
  }
  entities_[dimension_] = std::move(names[0]);
}

void MshWriter::requireInPlane(const Elements& elements, const Cell& cell) const {
  for (const GlobalOrdinal node : cell.nodes)
    if (pointOf(node)[2] != 0)
      throw InputError(deck::text(elements.place) + ": *ELEMENT: element " + std::to_string(cell.number) +
                       " of the type " + elements.type + " has node " + std::to_string(node) + " at z = " +
                       epafi::text(pointOf(node)[2]) + "; plane elements lie in the plane z = 0");
}

void MshWriter::addFacets(const MeshGroups& groups) {
  Entities& facets = entities_[dimension_ - 1];
  for (const auto& [face, own] : groupsOf(groups.surfaces, facets))
    for (const Elements& elements : deck_.elements) {
      const auto& [element, label] = face;
      const auto place = std::lower_bound(elements.numbers.begin(), elements.numbers.end(), element);
      if (place == elements.numbers.end() || *place != element)
        continue;
      const ElementForm& type = formOf(elements);
      if (label < 1 || label > std::ssize(type.faces))
        throw InputError(deck_.file + ": element " + std::to_string(element) + " of the type " +
                         elements.type + " has no face " + std::to_string(label));
      const std::size_t first = (place - elements.numbers.begin()) * elements.nodesPerElement;
      Cell cell{++lastNumber_, {}};
      for (const int corner : type.faces[label - 1])
        cell.nodes.push_back(elements.nodes[first + corner]);
      const int quadrilateral = 3, kind = cell.nodes.size() == 4 ? quadrilateral : type.facetKind;
      facets.add(own, kind, std::move(cell));
    }
}

void MshWriter::addNodes(const MeshGroups& groups) {
  for (const auto& [node, own] : groupsOf(groups.nodes, entities_[0]))
    if (nodes_.contains(node))
      entities_[0].add(own, pointKind, {++lastNumber_, {node}});
}

void MshWriter::writeNames(std::ostream& out) const {
  std::size_t number = 0;
  for (const Entities& each : entities_)
    number += each.names().size();
  out << "$PhysicalNames\n" << number << '\n';
  for (int d = 0; d < 4; ++d)
    for (const auto& [group, name] : entities_[d].names())
      out << d << ' ' << group << " \"" << name << "\"\n";
  out << "$EndPhysicalNames\n";
}

/// Their boxes are of no use to anyone here, and their borders are left open.
void MshWriter::writeEntities(std::ostream& out) const {
  out << "$Entities\n";
  for (int d = 0; d < 4; ++d)
    out << entities_[d].all().size() << (d == 3 ? '\n' : ' ');
  for (int d = 0; d < 4; ++d)
    for (std::size_t e = 0; e < entities_[d].all().size(); ++e) {
      out << e + 1 << (d == 0 ? " 0 0 0 " : " 0 0 0 0 0 0 ") << entities_[d].all()[e].groups.size();
      for (const int group : entities_[d].all()[e].groups)
        out << ' ' << group;
      out << (d == 0 ? "\n" : " 0\n");
    }
  out << "$EndEntities\n";
}

/// All in one block, of a point: no body takes it for its own.
void MshWriter::writeNodes(std::ostream& out) const {
  out << "$Nodes\n1 " << nodes_.size() << ' ' << *nodes_.begin() << ' ' << *nodes_.rbegin() << '\n'
      << "0 1 0 " << nodes_.size() << '\n';
  for (const GlobalOrdinal node : nodes_)
    out << node << '\n';
  for (const GlobalOrdinal node : nodes_)
    out << pointOf(node)[0] << ' ' << pointOf(node)[1] << ' ' << pointOf(node)[2] << '\n';
  out << "$EndNodes\n";
}

void MshWriter::writeElements(std::ostream& out) const {
  std::size_t blocks = 0, number = 0;
  for (const Entities& each : entities_)
    for (const Entity& entity : each.all()) {
      ++blocks;
      number += entity.cells.size();
    }
  out << "$Elements\n" << blocks << ' ' << number << " 1 " << lastNumber_ << '\n';
  for (int d = 0; d < 4; ++d)
    for (std::size_t e = 0; e < entities_[d].all().size(); ++e) {
      const Entity& entity = entities_[d].all()[e];
      out << d << ' ' << e + 1 << ' ' << entity.kind << ' ' << entity.cells.size() << '\n';
      for (const Cell& cell : entity.cells) {
        out << cell.number;
        for (const GlobalOrdinal node : cell.nodes)
          out << ' ' << node;
        out << '\n';
      }
    }
  out << "$EndElements\n";
}

std::string MshWriter::text() const {
  std::ostringstream out;
  out.precision(17);
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  writeNames(out);
  writeEntities(out);
  writeNodes(out);
  writeElements(out);
  return out.str();
}

} // namespace

std::string mshText(const Deck& deck, const MeshGroups& groups) {
  return MshWriter(deck, groups).text();
}

} // namespace epafi::deck
