#include "epafi/meshing/GmshBody.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

namespace epafi::meshing {

bool holds(const GmshGroup& group, int entity) {
  return std::binary_search(group.entities.begin(), group.entities.end(), entity);
}

std::vector<std::string> namesOf(const std::vector<GmshGroup>& groups) {
  std::vector<std::string> names;
  for (const GmshGroup& group : groups)
    names.push_back(group.name);
  return names;
}

/// Corners of elements of a kind.
std::size_t numCornersOfGmsh(int type) {
  return index(numNodesOfGmsh(linearKindOfGmsh(type)));
}

/// Which facets of the file, in its order, have all their corners in one of the elements.
std::vector<bool> facetsIn(const GmshContents& file, const GmshBlocks& elements) {
  using Nodes = std::span<const LocalOrdinal>;
  std::vector<std::vector<std::pair<std::size_t, Nodes>>> at(file.points.size()); // by their first nodes
  std::size_t numFacets = 0;
  for (const GmshBlock& block : file.facets) {
    const auto count = index(numNodesOfGmsh(block.type));
    for (std::size_t i = 0; i < block.nodes.size(); i += count)
      at[index(block.nodes[i])].emplace_back(numFacets++,
                                             Nodes(block.nodes).subspan(i, numCornersOfGmsh(block.type)));
  }
  std::vector<bool> isIn(numFacets, false);
  for (const GmshBlock* block : elements) {
    const auto count = index(numNodesOfGmsh(block->type));
    for (std::size_t i = 0; i < block->nodes.size(); i += count) {
      const Nodes element = Nodes(block->nodes).subspan(i, numCornersOfGmsh(block->type));
      for (const LocalOrdinal node : element)
        for (const auto& [facet, nodes] : at[index(node)])
          if (std::all_of(nodes.begin(), nodes.end(), [&](LocalOrdinal other) {
                return std::find(element.begin(), element.end(), other) != element.end();
              }))
            isIn[facet] = true;
    }
  }
  return isIn;
}

namespace {

/// Of order 1.
mesh::CellType cellOfGmsh(int type) {
  using enum mesh::CellType;
  constexpr std::array cells{line, line, triangle, quadrilateral, tetrahedron, hexahedron, prism, pyramid};
  return cells.at(index(linearKindOfGmsh(type)));
}

/// Makes the arrays of one body.
class BodyMaker {
public:
  BodyMaker(const GmshContents& file, const std::string& group, mesh::InnerNodes inner)
      : file_(file), group_(group), inner_(inner) {}

  mesh::MeshArrays make();

private:
  void chooseBlocks();
  void chooseCellType();
  void numberNodes();
  void addCells();
  void addGroups();
  void addSurfaces();
  void addNodeSets();
  [[noreturn]] void refuseGroup() const;
  [[nodiscard]] bool isOfBody(int entity) const { return chosen_ == nullptr || holds(*chosen_, entity); }

  const GmshContents& file_;
  const std::string& group_;
  mesh::InnerNodes inner_;
  const GmshGroup* chosen_ = nullptr; ///< null: all elements
  GmshBlocks blocks_;
  mesh::CellType given_{};              ///< of the largest elements, as they stand in the file
  std::vector<LocalOrdinal> newNumber_; ///< of each node of the file; −1: not of the body
  std::vector<int> entities_;           ///< of each element
  mesh::MeshArrays arrays_;
};

mesh::MeshArrays BodyMaker::make() {
  arrays_.name = group_.empty() ? "Mesh file " + inQuotes(file_.file)
                                : "Body " + inQuotes(group_) + " of the mesh file " + inQuotes(file_.file);
  chooseBlocks();
  chooseCellType();
  numberNodes();
  addCells();
  addGroups();
  addSurfaces();
  addNodeSets();
  return given_ == arrays_.cellType ? std::move(arrays_) : completed(std::move(arrays_), true);
}

void BodyMaker::chooseBlocks() {
  if (!group_.empty()) {
    const auto found = std::find_if(file_.groups.begin(), file_.groups.end(),
                                    [&](const GmshGroup& group) { return group.name == group_; });
    if (found == file_.groups.end())
      refuseGroup();
    chosen_ = &*found;
  }
  for (const GmshBlock& block : file_.elements)
    if (isOfBody(block.entity))
      blocks_.push_back(&block);
  if (blocks_.empty())
    throw InputError(arrays_.name + " has no elements; mesh it first");
}

void BodyMaker::refuseGroup() const {
  const std::vector<std::string> names = namesOf(file_.groups);
  std::vector<std::string> lower = namesOf(file_.surfaces);
  for (const mesh::NamedNodes& set : file_.nodeSets)
    lower.push_back(set.name);
  std::string text = "The mesh file " + inQuotes(file_.file) + " has no physical group " + inQuotes(group_) +
                     " of dimension " + std::to_string(file_.dimension);
  if (std::find(lower.begin(), lower.end(), group_) != lower.end())
    text += " (there is one of lower dimension, which is no body)";
  if (names.empty())
    throw InputError(text + ", and no other either; name its groups in Gmsh, or take all its elements");
  text += names.size() == 1 ? "; there is " : "; there are ";
  text += listed(names, "\"");
  const std::string near = nearestName(group_, names);
  throw InputError(near.empty() ? text : text + "; did you mean " + inQuotes(near) + '?');
}

/// Elements of one order, of any shapes; those of order 2 have as many nodes on their faces as others there.
void BodyMaker::chooseCellType() {
  std::set<int> shapes, kinds;
  mesh::CellType largest = mesh::CellType::triangle;
  for (const GmshBlock* block : blocks_) {
    kinds.insert(block->type);
    shapes.insert(linearKindOfGmsh(block->type));
    largest = std::max(largest, cellOfGmsh(block->type));
  }
  if (kinds.size() > shapes.size())
    throw InputError(arrays_.name +
                     " mixes elements of one shape with different numbers of nodes; mesh all of it "
                     "in one order");
  const auto isLinear = [](int kind) { return linearKindOfGmsh(kind) == kind; };
  if (std::any_of(kinds.begin(), kinds.end(), isLinear) && !std::all_of(kinds.begin(), kinds.end(), isLinear))
    throw InputError(arrays_.name + " mixes elements of order 1 and 2; mesh all of it in one order");
  if (!isLinear(*kinds.begin()))
    largest = withOrder(largest, 2);
  constexpr int prisms = 6, fullHexahedra = 12, fullPyramids = 14;
  const bool isMixedSolid = file_.dimension == 3 && (shapes.size() > 1 || *shapes.rbegin() >= prisms);
  for (const int kind : kinds)
    if (isMixedSolid && fullHexahedra <= kind && kind <= fullPyramids)
      throw InputError(
          arrays_.name + " has " + toString(cellOfGmsh(kind)) +
          "s with nodes in the middle of their faces, which those of prisms and pyramids here do "
          "not have; mesh with Mesh.SecondOrderIncomplete = 1, or in order 1, and ask for the "
          "\"Order\" 2");
  arrays_.cellType = isMixedSolid ? withoutInnerNodes(largest) : largest;
  given_ = arrays_.cellType;
  if (std::none_of(kinds.begin(), kinds.end(),
                   [&](int kind) { return numNodesOfGmsh(kind) == numNodesOf(given_); }))
    given_ = withoutInnerNodes(given_);
  if (inner_ == mesh::InnerNodes::none)
    arrays_.cellType = given_;
}

/// Places of a cell's nodes among those of Gmsh's element.
std::vector<std::size_t> placesInGmsh(mesh::CellType type) {
  std::vector<std::size_t> places(index(numNodesOf(type)));
  std::iota(places.begin(), places.end(), std::size_t{0});
  constexpr std::array<std::size_t, 18> hexahedron{11, 13, 9,  16, 18, 19, 17, 10, 12,
                                                   14, 15, 22, 23, 21, 24, 20, 25, 26};
  constexpr std::array<std::size_t, 8> prism{9, 7, 12, 14, 13, 8, 10, 11};
  constexpr std::array<std::size_t, 7> pyramid{8, 10, 6, 7, 9, 11, 12};
  if (type == mesh::CellType::tetrahedron10)
    std::swap(places[8], places[9]);
  else if (type == mesh::CellType::prism15)
    std::copy(prism.begin(), prism.end(), places.begin() + 7);
  else if (type == mesh::CellType::pyramid13)
    std::copy(pyramid.begin(), pyramid.end(), places.begin() + 6);
  else if (withInnerNodes(type) == mesh::CellType::hexahedron27)
    std::copy_n(hexahedron.begin(), places.size() - 9, places.begin() + 9);
  return places;
}

/// Nodes that the file lists inside the body count even if no element has them: the checks refuse them.
void BodyMaker::numberNodes() {
  newNumber_.assign(file_.points.size(), -1);
  for (const GmshBlock* block : blocks_)
    for (const LocalOrdinal node : block->nodes)
      newNumber_[index(node)] = 0;
  for (std::size_t n = 0; n < newNumber_.size(); ++n) {
    const auto [dimension, entity] = file_.nodeEntities[n];
    if (newNumber_[n] < 0 && !(dimension == file_.dimension && isOfBody(entity)))
      continue;
    newNumber_[n] = static_cast<LocalOrdinal>(arrays_.points.size());
    arrays_.points.push_back(file_.points[n]);
    arrays_.nodeTags.push_back(file_.nodeTags[n]);
  }
}

void BodyMaker::addCells() {
  struct Place {
    GlobalOrdinal tag;
    std::uint32_t block, element;
  };
  std::vector<Place> order;
  for (std::uint32_t b = 0; b < blocks_.size(); ++b)
    for (std::uint32_t e = 0; e < blocks_[b]->tags.size(); ++e)
      order.push_back({blocks_[b]->tags[e], b, e});
  std::sort(order.begin(), order.end(), [](const Place& a, const Place& b) { return a.tag < b.tag; });
  const auto perElement = index(numNodesOf(given_));
  std::map<int, std::vector<std::size_t>> placesOf; // by kind
  for (const GmshBlock* block : blocks_)
    placesOf[block->type] = placesInGmsh(cellOf(given_, index(numNodesOfGmsh(block->type))));
  arrays_.cells.reserve(order.size() * perElement);
  for (const Place& place : order) {
    const GmshBlock& block = *blocks_[place.block];
    const std::vector<std::size_t>& places = placesOf.at(block.type);
    const std::size_t first = arrays_.cells.size();
    for (const std::size_t i : places)
      arrays_.cells.push_back(newNumber_[index(block.nodes[place.element * places.size() + i])]);
    if (const LocalOrdinal last = arrays_.cells.back(); arrays_.cells[arrays_.cells.size() - 2] == last)
      throw InputError(arrays_.name + ": element " + std::to_string(place.tag) + " has node " +
                       std::to_string(arrays_.nodeTags[index(last)]) + " twice; give it " +
                       std::to_string(places.size()) + " different nodes");
    mesh::fillRow(arrays_.cells, first, perElement);
    arrays_.elementTags.push_back(place.tag);
    entities_.push_back(block.entity);
  }
}

void BodyMaker::addGroups() {
  for (const GmshGroup& group : file_.groups) {
    if (&group == chosen_)
      continue;
    mesh::NamedElements part{group.name, {}};
    for (LocalOrdinal e = 0; e < std::ssize(entities_); ++e)
      if (holds(group, entities_[e]))
        part.elements.push_back(e);
    if (!part.elements.empty())
      arrays_.groups.push_back(std::move(part));
  }
}

void BodyMaker::addSurfaces() {
  const auto perFacet = index(numCornersOf(facetTypeOf(arrays_.cellType)));
  const std::vector<bool> isIn = facetsIn(file_, blocks_);
  const auto hasFacets = [&](std::size_t corners) {
    return std::any_of(blocks_.begin(), blocks_.end(), [&](const GmshBlock* block) {
      const auto facets = facetsOf(cellOfGmsh(block->type));
      return facets.front().size() == corners || facets.back().size() == corners;
    });
  };
  for (const GmshGroup& surface : file_.surfaces) {
    mesh::NamedFacets part{surface.name, {}};
    std::size_t facet = 0;
    for (const GmshBlock& block : file_.facets) {
      const auto count = index(numNodesOfGmsh(block.type));
      for (std::size_t i = 0; i < block.tags.size(); ++i) {
        if (!isIn[facet++] || !holds(surface, block.entity))
          continue;
        if (!hasFacets(numCornersOfGmsh(block.type)))
          throw InputError(arrays_.name + ": the surface " + inQuotes(surface.name) + " has a facet of " +
                           std::to_string(count) + " nodes (element " + std::to_string(block.tags[i]) +
                           "), but those of the body's elements have " + std::to_string(perFacet) +
                           " corners; mesh surface and body together");
        const std::size_t first = part.nodes.size();
        for (const LocalOrdinal node :
             std::span(block.nodes).subspan(i * count, numCornersOfGmsh(block.type)))
          part.nodes.push_back(newNumber_[index(node)]);
        mesh::fillRow(part.nodes, first, perFacet);
      }
    }
    if (!part.nodes.empty())
      arrays_.surfaces.push_back(std::move(part));
  }
}

/// Those of the file of which the body has a node.
void BodyMaker::addNodeSets() {
  for (const mesh::NamedNodes& set : file_.nodeSets) {
    mesh::NamedNodes part{set.name, {}};
    for (const LocalOrdinal node : set.nodes)
      if (newNumber_[index(node)] >= 0)
        part.nodes.push_back(newNumber_[index(node)]);
    if (!part.nodes.empty())
      arrays_.nodeSets.push_back(std::move(part));
  }
}

} // namespace

mesh::MeshArrays arraysOfBody(const GmshContents& file, const std::string& group, mesh::InnerNodes inner) {
  return BodyMaker(file, group, inner).make();
}

} // namespace epafi::meshing
