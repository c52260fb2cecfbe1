#include "epafi/output/ContactGeometry.hpp"

#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/output/ElementMaterials.hpp"

#include <algorithm>
#include <span>
#include <unordered_map>

namespace epafi::output {
namespace {

/// Where thicknesses differ, the facets share their areas as decomposition::surfaceNodes does, thickness by thickness.
std::vector<double> areasOfRegions(const SolvedScene& solved, int contact) {
  const auto& layout = solved.decomposition.contacts[static_cast<std::size_t>(contact)];
  const auto& body = solved.decomposition.bodies[static_cast<std::size_t>(layout.firstBody)];
  const scene::Solid& solid = *solved.elasticBody(layout.firstBody);
  const ElementMaterials materials(body.name, solid, *body.mesh);
  std::unordered_map<GlobalOrdinal, std::size_t> rowOf;
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    rowOf.emplace(layout.firstNodes[row], row);

  const fem::Surface surface = body.mesh->surface(solved.surfaceContact(contact)->firstSurface);
  const auto perFacet = static_cast<std::size_t>(surface.nodesPerFacet);
  std::vector<double> areas(layout.firstNodes.size(), 0.0);
  std::vector<fem::Point> corners(perFacet);
  for (std::size_t f = 0; f < surface.elements.size(); ++f) {
    const auto nodes = std::span(surface.facetNodes).subspan(f * perFacet, perFacet);
    std::transform(nodes.begin(), nodes.end(), corners.begin(),
                   [&](GlobalOrdinal node) { return body.mesh->point(node); });
    const double thickness = fem::thicknessOf(solid.physics, materials.of(surface.elements[f]));
    const std::array<double, 4> shares = fem::nodalShares(corners);
    for (std::size_t a = 0; a < perFacet; ++a)
      if (const auto row = rowOf.find(nodes[a]); row != rowOf.end())
        areas[row->second] += thickness * shares[a];
  }
  return areas;
}

} // namespace

std::vector<double> pressureAreas(const SolvedScene& solved, int contact) {
  const auto& layout = solved.decomposition.contacts[static_cast<std::size_t>(contact)];
  const scene::Solid* solid = solved.elasticBody(layout.firstBody);
  if (solid == nullptr || solid->physics == scene::Physics::elasticity3d)
    return layout.areas;
  if (!solid->regions.empty())
    return areasOfRegions(solved, contact);
  std::vector<double> areas = layout.areas;
  for (double& area : areas)
    area *= fem::thicknessOf(solid->physics, solid->material);
  return areas;
}

std::array<double, 3> directionOf(const decomposition::ContactLayout& contact, std::size_t row) {
  const std::size_t components = contact.directions.size() / contact.firstNodes.size();
  if (components == 1)
    return {0, 0, contact.directions[row]};
  std::array<double, 3> direction{};
  std::copy_n(contact.directions.begin() + static_cast<std::ptrdiff_t>(row * components), components,
              direction.begin());
  return direction;
}

} // namespace epafi::output
