#include "epafi/output/ContactGeometry.hpp"

#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/HookesLaw.hpp"

#include <algorithm>
#include <span>
#include <unordered_map>

namespace epafi::output {
namespace {

/// Where thicknesses differ, the facets share their areas as decomposition::surfaceNodes does, thickness by thickness.
std::vector<double> areasOfRegions(const SolvedScene& solved, int contact) {
  const auto& layout = solved.decomposition.contacts[static_cast<std::size_t>(contact)];
  const auto& body = solved.decomposition.bodies[static_cast<std::size_t>(layout.firstBody)];
  const scene::Body& solid = *solved.elasticBody(layout.firstBody);
  const fem::BodyModel model(solid, *body.mesh);
  std::unordered_map<GlobalOrdinal, std::size_t> rowOf;
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    rowOf.emplace(layout.firstNodes[row], row);

  const fem::Surface surface = body.mesh->surface(solved.surfaceContact(contact)->firstSurface);
  std::vector<double> areas(layout.firstNodes.size(), 0.0);
  std::vector<fem::Point> corners;
  std::vector<double> shares(static_cast<std::size_t>(surface.nodesPerFacet()));
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    body.mesh->pointsAt(nodes, corners);
    const double thickness = fem::thicknessOf(solid.physics, model.materialOf(surface.elements[f]));
    fem::nodalShares(surface.facetType, corners, shares);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      if (const auto row = rowOf.find(nodes[a]); row != rowOf.end())
        areas[row->second] += thickness * shares[a];
  }
  return areas;
}

} // namespace

std::vector<double> pressureAreas(const SolvedScene& solved, int contact) {
  const auto& layout = solved.decomposition.contacts[static_cast<std::size_t>(contact)];
  const scene::Body* solid = solved.elasticBody(layout.firstBody);
  if (solid == nullptr || solid->physics == scene::Physics::elasticity3d)
    return layout.areas;
  if (!solid->regions.empty())
    return areasOfRegions(solved, contact);
  std::vector<double> areas = layout.areas;
  for (double& area : areas)
    area *= fem::thicknessOf(solid->physics, solid->material);
  return areas;
}

std::array<double, 3> directionOf(const contact::ContactLayout& contact, std::size_t row) {
  const std::size_t components = contact.directions.size() / contact.firstNodes.size();
  if (components == 1)
    return {0, 0, contact.directions[row]};
  std::array<double, 3> direction{};
  std::copy_n(contact.directions.begin() + static_cast<std::ptrdiff_t>(row * components), components,
              direction.begin());
  return direction;
}

} // namespace epafi::output
