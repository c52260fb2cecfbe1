#include "epafi/contact/UnitedSurface.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

namespace epafi::contact {

UnitedSurface unite(const mesh::Mesh& mesh, std::span<const std::string> names) {
  UnitedSurface result{mesh.surface(names.front()), {}};
  mesh::Surface& all = result.surface;
  result.parts.assign(all.numFacets(), 0);
  if (names.size() == 1)
    return result;
  std::set<std::vector<GlobalOrdinal>> known;
  const auto isNew = [&](std::span<const GlobalOrdinal> nodes) {
    std::vector<GlobalOrdinal> key(nodes.begin(), nodes.end());
    std::sort(key.begin(), key.end());
    return known.insert(std::move(key)).second;
  };
  for (std::size_t f = 0; f < all.numFacets(); ++f)
    isNew(all.facet(f));
  for (std::size_t part = 1; part < names.size(); ++part) {
    const mesh::Surface next = mesh.surface(names[part]);
    for (std::size_t f = 0; f < next.numFacets(); ++f)
      if (isNew(next.facet(f))) {
        all.add(next.facet(f));
        all.elements.push_back(next.elements[f]);
        result.parts.push_back(part);
      }
  }
  return result;
}

void turnOver(mesh::Surface& surface) {
  mesh::Surface turned{surface.facetType, {}, {}};
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto facet = surface.facet(f);
    std::vector<GlobalOrdinal> nodes(facet.begin(), facet.end());
    const auto corners = nodes.begin() + numCornersOf(surface.typeOf(f));
    std::reverse(nodes.begin(), corners);
    if (corners != nodes.end()) // then come the middles of edges, the last one from last to first
      std::reverse(corners, corners + (corners - nodes.begin()) - 1);
    turned.add(nodes);
  }
  surface.facetNodes = std::move(turned.facetNodes);
}

} // namespace epafi::contact
