#include "epafi/contact/BasisChange.hpp"

#include "epafi/fem/ElementGeometry.hpp"

#include <array>
#include <map>

namespace epafi::contact {
namespace {

constexpr double alpha = 0.2;

} // namespace

void changeBasis(const fem::Mesh& mesh, const fem::Surface& surface, ContactLayout& contact) {
  if (surface.facetType != fem::CellType::triangle6)
    return;
  std::map<GlobalOrdinal, std::size_t> rowOf;
  for (std::size_t row = 0; row < contact.firstNodes.size(); ++row)
    rowOf.emplace(contact.firstNodes[row], row);
  contact.combinations.resize(contact.firstNodes.size());
  for (std::size_t row = 0; row < contact.firstNodes.size(); ++row)
    contact.combinations[row] = {{row, 1.0}};
  contact.areas.assign(contact.areas.size(), 0.0);

  constexpr std::size_t corners = 3;
  std::vector<fem::Point> points;
  std::array<double, 2 * corners> shares{};
  const auto ends = fem::edgesOf(surface.facetType);
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    mesh.pointsAt(nodes, points);
    fem::nodalShares(surface.facetType, points, shares);
    for (std::size_t edge = 0; edge < corners; ++edge) {
      const double share = shares[corners + edge]; // ∫N_m, of which each end takes α
      const auto middle = rowOf.find(nodes[corners + edge]);
      std::vector<ContactLayout::Share> combination;
      for (const std::size_t end : {2 * edge, 2 * edge + 1}) {
        const auto place = static_cast<std::size_t>(ends[end]);
        if (const auto corner = rowOf.find(nodes[place]); corner != rowOf.end()) {
          contact.areas[corner->second] += alpha * share + 0.5 * shares[place];
          combination.push_back({corner->second, -alpha / (1 - 2 * alpha)});
        }
      }
      if (middle == rowOf.end())
        continue;
      contact.areas[middle->second] += (1 - 2 * alpha) * share;
      combination.push_back({middle->second, 1 / (1 - 2 * alpha)});
      if (combination.size() == 3)
        contact.combinations[middle->second] = std::move(combination);
    }
  }
}

} // namespace epafi::contact
