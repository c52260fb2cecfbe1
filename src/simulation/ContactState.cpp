#include "epafi/simulation/ContactState.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/Slab.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"
#include "epafi/simulation/RowShares.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <map>
#include <span>
#include <unordered_map>

namespace epafi::simulation {
namespace {

using contact::ContactLayout;

/// Penetration is looked for at this many points and one along each edge of a facet.
constexpr int latticeSteps = 8;

const mesh::Mesh& meshOf(const SolvedScene& solved, const ContactLayout& layout) {
  return *solved.decomposition.bodies[layout.firstBody].mesh;
}

/// Values of all rows that combinations of some rows name, wherever they lie.
class RowValues {
public:
  /// Collective.
  RowValues(const Vector& whole, const ContactLayout& layout, const std::vector<std::size_t>& rows,
            const RowShares& combinations)
      : combinations_(combinations) {
    std::vector<GlobalOrdinal> needed;
    for (const std::size_t row : rows)
      forEachRow(combinations, row,
                 [&](std::size_t other, double) { needed.push_back(layout.firstRow + other); });
    const auto map = makeMap(std::move(needed), whole.getMap()->getComm());
    Vector here(map);
    here.doImport(whole, Import(whole.getMap(), map), Tpetra::INSERT);
    const auto data = here.getData();
    for (LocalOrdinal i = 0; i < data.size(); ++i)
      values_.emplace(map->getGlobalElement(i) - layout.firstRow, data[i]);
  }

  /// Σ weight · value of a row's combination.
  [[nodiscard]] double at(std::size_t row) const {
    double sum = 0;
    forEachRow(combinations_, row,
               [&](std::size_t other, double weight) { sum += weight * values_.at(other); });
    return sum;
  }

private:
  const RowShares& combinations_;
  std::unordered_map<std::size_t, double> values_;
};

/// What rows contribute to the forces on the nodes that have one; empty: each row is that of its own node.
RowShares forceShares(const ContactLayout& layout) {
  if (layout.firstShares.empty())
    return transposed(layout.combinations);
  std::unordered_map<GlobalOrdinal, std::size_t> rowOf;
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    rowOf.emplace(layout.firstNodes[row], row);
  RowShares result(layout.firstNodes.size());
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    for (const contact::NodeShare& share : layout.firstShares[row])
      if (const auto place = rowOf.find(share.node); place != rowOf.end())
        result[place->second].push_back({row, share.weight});
      else // a node beyond the rim or held, which has no row: its force counts with the row's own node
        result[row].push_back({row, share.weight});
  return result;
}

/// Values of a facet's shape functions at a lattice of points.
std::vector<Eigen::VectorXd> latticeOn(mesh::CellType facet) {
  return withFacetShape(facet, []<int dim>(const mesh::Shape<dim>& shape) {
    constexpr int across = dim == 1 ? 0 : latticeSteps;
    std::vector<Eigen::VectorXd> values;
    for (int i = 0; i <= latticeSteps; ++i)
      for (int j = 0; j <= across && (!shape.isSimplex || i + j <= latticeSteps); ++j) {
        mesh::Coordinates<dim> xi = mesh::Coordinates<dim>::Constant(static_cast<double>(j) / latticeSteps);
        xi[0] = static_cast<double>(i) / latticeSteps;
        if (!shape.isSimplex)
          xi = (2 * xi.array() - 1).matrix();
        values.emplace_back(shape.values(xi));
      }
    return values;
  });
}

/// Of the facets that are this rank's. Collective.
double penetrationOn(const mesh::Surface& surface, const ContactLayout& layout, const RowShares& toNodes,
                     const Vector& slack) {
  const std::vector<long long> all = completeFacets(layout, surface);
  const std::size_t perFacet = surface.nodesPerFacet();
  const RowRange mine = evenShare(all.size() / perFacet, *slack.getMap()->getComm());
  const auto begin = all.begin() + mine.first * static_cast<GlobalOrdinal>(perFacet);
  const std::vector<std::size_t> rows(begin, begin + mine.count * static_cast<GlobalOrdinal>(perFacet));
  const RowValues gaps(slack, layout, rows, toNodes);
  std::map<std::size_t, std::vector<Eigen::VectorXd>> lattices; // by the number of nodes
  double deepest = 0;
  for (std::size_t facet = 0; facet < rows.size(); facet += perFacet) {
    const auto own = mesh::withoutFilling(std::span(rows).subspan(facet, perFacet));
    std::vector<Eigen::VectorXd>& lattice = lattices[own.size()];
    if (lattice.empty())
      lattice = latticeOn(cellOf(surface.facetType, own.size()));
    Eigen::VectorXd gap(own.size());
    for (std::size_t a = 0; a < own.size(); ++a)
      gap[a] = gaps.at(own[a]);
    for (const Eigen::VectorXd& shape : lattice)
      deepest = std::max(deepest, -shape.dot(gap));
  }
  return deepest;
}

} // namespace

std::vector<long long> completeFacets(const ContactLayout& layout, const mesh::Surface& surface) {
  std::unordered_map<GlobalOrdinal, long long> rowOf;
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    rowOf.emplace(layout.firstNodes[row], row);
  std::vector<long long> corners;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    if (!std::all_of(nodes.begin(), nodes.end(), [&](GlobalOrdinal node) { return rowOf.contains(node); }))
      continue;
    const std::size_t first = corners.size();
    for (const GlobalOrdinal node : nodes)
      corners.push_back(rowOf.at(node));
    mesh::fillRow(corners, first, surface.nodesPerFacet());
  }
  return corners;
}

ContactState contactState(const SolvedScene& solved, int contact) {
  const ContactLayout& layout = solved.decomposition.contacts[contact];
  const Vector& multiplier = *solved.solution.multiplier;
  Vector slack(*solved.solution.slack, Teuchos::Copy); // c − Bu
  if (const RCP<const Vector>& compliance = solved.decomposition.problem.compliance; !compliance.is_null())
    slack.elementWiseMultiply(-1.0, *compliance, multiplier, 1.0);
  const RowShares around = sharesOfMeans(layout), toNodes = sharesOfSlacks(layout);

  const std::vector<std::size_t> own = layout.ownRows();
  const RowRange slab = evenShare(own.size(), solved.comm());
  const std::vector<std::size_t> rows(own.begin() + slab.first, own.begin() + slab.first + slab.count);
  const RowShares onNodes = forceShares(layout);
  const RowValues forces(multiplier, layout, rows, onNodes), pushes(multiplier, layout, rows, around),
      gaps(slack, layout, rows, toNodes);

  ContactState state;
  state.areas = layout.areas;
  for (const std::size_t row : rows) {
    double area = 0;
    forEachRow(around, row, [&](std::size_t other, double weight) { area += weight * state.areas[other]; });
    state.force.push_back(layout.portion(row) * forces.at(row));
    state.pressure.push_back(pushes.at(row) / area);
    state.gap.push_back(gaps.at(row));
    state.largestPressure = std::max(state.largestPressure, state.pressure.back());
    state.penetration = std::max(state.penetration, -state.gap.back());
  }
  if (!layout.smoothed.empty())
    state.penetration =
        std::max(state.penetration,
                 penetrationOn(meshOf(solved, layout).surface(layout.firstSurface), layout, toNodes, slack));
  for (std::size_t row = 0; row < state.areas.size(); ++row)
    state.areas[row] *= layout.portion(row);
  state.largestPressure = maxOverRanks(solved.comm(), state.largestPressure);
  state.penetration = maxOverRanks(solved.comm(), state.penetration);
  return state;
}

} // namespace epafi::simulation
