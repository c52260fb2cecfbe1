#include "epafi/meshing/BracedParts.hpp"

#include "epafi/mesh/BracedElements.hpp"

#include <algorithm>
#include <map>

namespace epafi::meshing {
namespace {

/// Moves the first element that its part does not brace, or joins its part with another one; fewer facets lie
/// between parts then. Returns false if there is no such element.
bool braceOne(const mesh::Mesh& mesh, std::vector<int>& part) {
  std::vector<GlobalOrdinal> adjacent;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const int own = part[element];
    const auto isIn = [&](int wanted) {
      return [&part, wanted](GlobalOrdinal other) { return part[other] == wanted; };
    };
    if (isBraced(mesh, element, isIn(own)))
      continue;
    std::map<int, int> facets; // shared with each part
    mesh.elementNeighbours(element, adjacent);
    for (const GlobalOrdinal other : adjacent)
      ++facets[part[other]];
    const int numOwn = facets[own];
    facets.erase(own);
    if (facets.empty())
      continue;
    const auto [target, number] = *std::max_element(
        facets.begin(), facets.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (number > numOwn && numOwn < 2 && isBraced(mesh, element, isIn(target)))
      part[element] = target; // the end of its part, if not all of it
    else
      std::replace(part.begin(), part.end(), own, target);
    return true;
  }
  return false;
}

} // namespace

void makeBraced(const mesh::Mesh& mesh, std::vector<int>& part) {
  while (braceOne(mesh, part)) {
    // Fewer facets lie between parts each time.
  }
}

} // namespace epafi::meshing
