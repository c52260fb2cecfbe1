#include "epafi/output/ContactFields.hpp"

#include "epafi/base/Maps.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <map>
#include <numeric>

namespace epafi::output {
namespace {

using contact::ContactLayout;

std::vector<double> rowsOf(const Vector& whole, const Import& toSlab) {
  Vector slab(toSlab.getTargetMap());
  slab.doImport(whole, toSlab, Tpetra::INSERT);
  const auto data = slab.getData();
  return {data.begin(), data.end()};
}

void fillFacets(const simulation::SolvedScene& solved, int contact, ContactFields& fields) {
  const ContactLayout& layout = solved.decomposition.contacts[contact];
  std::vector<long long> corners;
  if (!solved.isAlongEdges(contact)) {
    const mesh::Mesh& mesh = *solved.decomposition.bodies[layout.firstBody].mesh;
    const mesh::Surface surface = mesh.surface(layout.firstSurface);
    const std::vector<long long> all = simulation::completeFacets(layout, surface);
    const std::vector<std::size_t> own = layout.ownRows();
    const std::ptrdiff_t perFacet = surface.nodesPerFacet();
    for (auto begin = all.begin(); begin != all.end(); begin += perFacet) {
      if (std::any_of(begin, begin + perFacet, [&](long long row) { return layout.portion(row) == 0; }))
        continue;
      for (auto row = begin; row != begin + perFacet; ++row)
        corners.push_back(std::lower_bound(own.begin(), own.end(), *row) - own.begin());
    }
    if (!corners.empty())
      fields.facetType = surface.facetType;
  }
  if (corners.empty()) {
    corners.resize(fields.numRows);
    std::iota(corners.begin(), corners.end(), 0LL);
  }
  const int perFacet = fields.nodesPerFacet();
  fields.numFacets = std::ssize(corners) / perFacet;
  fields.facets = evenShare(fields.numFacets, solved.comm());
  const auto begin = corners.begin() + fields.facets.first * perFacet;
  fields.corners.assign(begin, begin + fields.facets.count * perFacet);
}

} // namespace

FacingSurface facingSurface(const simulation::SolvedScene& solved, int contact) {
  const ContactLayout& layout = solved.decomposition.contacts[contact];
  FacingSurface result;
  if (layout.firstShares.empty())
    return result;
  const scene::SurfaceContact& terms = solved.scene.contacts[layout.number];
  const mesh::Mesh& mesh = *solved.decomposition.bodies[layout.secondBody].mesh;
  const mesh::Surface surface =
      mesh.surface(layout.secondBody == terms.second ? terms.secondSurface : terms.firstSurface);
  result.cornersPerFacet = numCornersOf(surface.facetType);
  result.numFacets = surface.numFacets();
  std::map<GlobalOrdinal, long long> placeOf;
  for (std::size_t f = 0; f < surface.numFacets(); ++f)
    for (const GlobalOrdinal node : surface.corners(f))
      placeOf.emplace(node, 0);
  result.numPoints = placeOf.size();
  result.points = evenShare(result.numPoints, solved.comm());
  result.facets = evenShare(result.numFacets, solved.comm());
  GlobalOrdinal next = 0;
  for (auto& [node, place] : placeOf) {
    place = next++;
    if (place < result.points.first || place >= result.points.first + result.points.count)
      continue;
    const Point point = mesh.point(node);
    result.places.insert(result.places.end(), point.begin(), point.end());
  }
  for (GlobalOrdinal f = result.facets.first; f < result.facets.first + result.facets.count; ++f) {
    const std::size_t begin = result.corners.size();
    for (const GlobalOrdinal node : surface.corners(f))
      result.corners.push_back(placeOf.at(node));
    mesh::fillRow(result.corners, begin, result.cornersPerFacet);
  }
  return result;
}

ContactFields gatherContactFields(const simulation::SolvedScene& solved, int contact,
                                  const simulation::ContactState& state) {
  const auto& problem = solved.decomposition.problem;
  const ContactLayout& layout = solved.decomposition.contacts[contact];
  const mesh::Mesh& mesh = *solved.decomposition.bodies[layout.firstBody].mesh;

  ContactFields fields;
  const std::vector<std::size_t> own = layout.ownRows();
  fields.numRows = own.size();
  fields.rows = evenShare(fields.numRows, *problem.comm);
  std::vector<GlobalOrdinal> multipliers;
  for (GlobalOrdinal k = fields.rows.first; k < fields.rows.first + fields.rows.count; ++k) {
    const std::size_t row = own[k];
    multipliers.push_back(layout.firstRow + row);
    const Point point = mesh.point(layout.firstNodes[row]);
    fields.points.insert(fields.points.end(), point.begin(), point.end());
    const Eigen::Vector3d normal = layout.spatialDirectionOf(row);
    fields.normals.insert(fields.normals.end(), normal.begin(), normal.end());
    fields.areas.push_back(state.areas[row]);
  }
  fillFacets(solved, contact, fields);

  const auto slab = mapInOrder(multipliers, problem.comm);
  const Import toSlab(problem.multiplierMap, slab);
  fields.initialGap = rowsOf(solved.decomposition.data.gap(), toSlab);
  fields.gap = state.gap;
  fields.multiplier = rowsOf(*solved.solution.multiplier, toSlab);
  for (GlobalOrdinal k = 0; k < fields.rows.count; ++k)
    fields.multiplier[k] *= layout.portion(own[fields.rows.first + k]);
  fields.force = state.force;
  fields.pressure = state.pressure;
  for (const double value : rowsOf(*solved.solution.active, toSlab))
    fields.active.push_back(value > 0.5 ? 1 : 0);
  if (layout.firstFriction >= 0)
    fields.friction = simulation::frictionFields(solved, layout);
  return fields;
}

} // namespace epafi::output
