#include "epafi/output/ContactFields.hpp"

#include "epafi/base/Maps.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/HookesLaw.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace epafi::output {
namespace {

using contact::ContactLayout;

std::vector<double> rowsOf(const Vector& whole, const Import& toSlab) {
  Vector slab(toSlab.getTargetMap());
  slab.doImport(whole, toSlab, Tpetra::INSERT);
  const auto data = slab.getData();
  return {data.begin(), data.end()};
}

/// Facets of the first surface, as rows, whose nodes all have one.
std::vector<long long> completeFacets(const ContactLayout& layout, const fem::Surface& surface) {
  std::unordered_map<GlobalOrdinal, long long> rowOf;
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    rowOf.emplace(layout.firstNodes[row], static_cast<long long>(row));
  std::vector<long long> corners;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    if (std::all_of(nodes.begin(), nodes.end(), [&](GlobalOrdinal node) { return rowOf.contains(node); }))
      for (const GlobalOrdinal node : nodes)
        corners.push_back(rowOf.at(node));
  }
  return corners;
}

void fillFacets(const SolvedScene& solved, int contact, ContactFields& fields) {
  const ContactLayout& layout = solved.decomposition.contacts[static_cast<std::size_t>(contact)];
  std::vector<long long> corners;
  if (const scene::SurfaceContact* between = solved.surfaceContact(contact)) {
    const fem::Mesh& mesh = *solved.decomposition.bodies[static_cast<std::size_t>(layout.firstBody)].mesh;
    const fem::Surface surface = mesh.surface(between->firstSurface);
    corners = completeFacets(layout, surface);
    if (!corners.empty())
      fields.facetType = surface.facetType;
  }
  if (corners.empty()) {
    corners.resize(layout.firstNodes.size());
    std::iota(corners.begin(), corners.end(), 0LL);
  }
  const int perFacet = fields.nodesPerFacet();
  fields.numFacets = static_cast<GlobalOrdinal>(corners.size()) / perFacet;
  fields.facets = evenShare(fields.numFacets, solved.comm());
  const auto begin = corners.begin() + fields.facets.first * perFacet;
  fields.corners.assign(begin, begin + fields.facets.count * perFacet);
}

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
  std::array<double, 3> direction{};
  contact.forEachShare(row, [&](std::size_t node, double weight) {
    for (std::size_t c = 0; c < components; ++c) // of membranes along z
      direction[components == 1 ? 2 : c] += weight * contact.directions[node * components + c];
  });
  return direction;
}

ContactFields gatherContactFields(const SolvedScene& solved, int contact, std::span<const double> areas) {
  const auto& problem = solved.decomposition.problem;
  const ContactLayout& layout = solved.decomposition.contacts[static_cast<std::size_t>(contact)];
  const fem::Mesh& mesh = *solved.decomposition.bodies[static_cast<std::size_t>(layout.firstBody)].mesh;

  ContactFields fields;
  fields.numRows = layout.numRows();
  fields.rows = evenShare(layout.numRows(), *problem.comm);
  std::vector<GlobalOrdinal> multipliers;
  for (GlobalOrdinal k = fields.rows.first; k < fields.rows.first + fields.rows.count; ++k) {
    const auto row = static_cast<std::size_t>(k);
    multipliers.push_back(layout.firstRow + k);
    const fem::Point point = mesh.point(layout.firstNodes[row]);
    fields.points.insert(fields.points.end(), point.begin(), point.end());
    const std::array<double, 3> normal = directionOf(layout, row);
    fields.normals.insert(fields.normals.end(), normal.begin(), normal.end());
    fields.areas.push_back(areas[row]);
  }
  fillFacets(solved, contact, fields);

  const auto slab = mapInOrder(multipliers, problem.comm);
  const Import toSlab(problem.multiplierMap, slab);
  fields.initialGap = rowsOf(*problem.gap, toSlab);
  fields.gap = rowsOf(*solved.solution.slack, toSlab);
  fields.multiplier = rowsOf(*solved.solution.multiplier, toSlab);
  for (std::size_t k = 0; k < fields.multiplier.size(); ++k)
    fields.pressure.push_back(fields.multiplier[k] / fields.areas[k]);
  for (const double value : rowsOf(*solved.solution.active, toSlab))
    fields.active.push_back(value > 0.5 ? 1 : 0);
  return fields;
}

} // namespace epafi::output
