#include "epafi/fem/GmshContents.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <numeric>

namespace epafi::fem {
namespace {

constexpr int pointType = 15;

} // namespace

int numNodesOfGmsh(int type) {
  // line 1, triangle, quadrilateral, tetrahedron, hexahedron, prism, pyramid 7
  constexpr std::array<int, 8> counts{0, 2, 3, 4, 4, 8, 6, 5};
  if (type == pointType)
    return 1;
  return type > 0 && type < 8 ? counts[static_cast<std::size_t>(type)] : 0;
}

int dimensionOfGmsh(int type) {
  return type == pointType ? 0 : type == 1 ? 1 : type < 4 ? 2 : 3;
}

std::string notLinear(int type, GlobalOrdinal element) {
  return "element " + std::to_string(element) + " is of Gmsh's kind " + std::to_string(type) +
         ", of second or higher order or unknown; only linear elements are allowed, so mesh with "
         "Mesh.ElementOrder = 1";
}

void GmshContents::setNodes(const std::vector<GlobalOrdinal>& tags, const std::vector<Point>& places,
                            const std::vector<std::array<int, 2>>& entities) {
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  for (const std::size_t i : order) {
    if (!nodeTags.empty() && nodeTags.back() == tags[i])
      throw InputError("The mesh file \"" + file + "\" lists node " + std::to_string(tags[i]) +
                       " twice; number its nodes differently, or mesh anew");
    nodeTags.push_back(tags[i]);
    points.push_back(places[i]);
    nodeEntities.push_back(entities[i]);
  }
}

LocalOrdinal GmshContents::nodeOf(GlobalOrdinal tag) const {
  // Mostly numbers have no gaps, and there is nothing to search.
  if (!nodeTags.empty() && tag >= nodeTags.front()) {
    const auto guess = static_cast<std::size_t>(tag - nodeTags.front());
    if (guess < nodeTags.size() && nodeTags[guess] == tag)
      return static_cast<LocalOrdinal>(guess);
  }
  const auto found = std::lower_bound(nodeTags.begin(), nodeTags.end(), tag);
  if (found == nodeTags.end() || *found != tag)
    throw InputError("The mesh file \"" + file + "\" has an element with node " + std::to_string(tag) +
                     ", but no such node; mesh anew");
  return static_cast<LocalOrdinal>(found - nodeTags.begin());
}

void GmshContents::addGroup(std::vector<GmshGroup>& list, int groupDimension, int number,
                            GmshGroup group) const {
  if (group.name.empty())
    group.name = std::to_string(number);
  std::sort(group.entities.begin(), group.entities.end());
  if (std::any_of(list.begin(), list.end(), [&](const GmshGroup& other) { return other.name == group.name; }))
    throw InputError("The mesh file \"" + file + "\" has two physical groups \"" + group.name +
                     "\" of dimension " + std::to_string(groupDimension) + "; give them different names");
  list.push_back(std::move(group));
}

void GmshContents::refuseNoElements() const {
  throw InputError("The mesh file \"" + file +
                   "\" holds no elements of dimension 2 or 3; mesh its surfaces or volumes, and save all of "
                   "them or those in physical groups");
}

} // namespace epafi::fem
