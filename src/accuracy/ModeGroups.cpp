#include "epafi/accuracy/ModeGroups.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace epafi::accuracy {
namespace {

/// Nodes of a facet, ascending, as places among those of the facet.
std::vector<int> ascending(const mesh::Facet& facet, std::span<const GlobalOrdinal> nodes) {
  std::vector<int> order(facet.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return nodes[facet[a]] < nodes[facet[b]]; });
  return order;
}

/// Moments without force and moment at the nodes of a facet, orthonormal columns. \param isFree  components
/// that may be other than 0
Eigen::MatrixXd facetModes(const std::vector<Point>& points, Eigen::Index components, Eigen::Index dimension,
                           const std::array<bool, 3>& isFree) {
  const Eigen::Index number = std::ssize(points);
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(number * components, components * (components + 1) / 2);
  double size = 0;
  for (const Point& point : points)
    for (Eigen::Index c = 0; c < dimension; ++c)
      size = std::max(size, std::abs(point[c] - points[0][c]));
  bool isWholly = true;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index a = 0; a < number; ++a)
    for (Eigen::Index c = 0, turn = components; c < components; ++c) {
      motions(a * components + c, c) = 1;
      for (Eigen::Index d = c + 1; d < components; ++d, ++turn) {
        motions(a * components + c, turn) = (points[a][d] - points[0][d]) / size;
        motions(a * components + d, turn) = -(points[a][c] - points[0][c]) / size;
      }
      isWholly = isWholly && isFree.at(c);
      if (isFree.at(c))
        rows.push_back(a * components + c);
    }
  if (isWholly)
    return direct::orthogonalComplement(motions);
  Eigen::MatrixXd free(rows.size(), motions.cols());
  for (std::size_t i = 0; i < rows.size(); ++i)
    free.row(static_cast<Eigen::Index>(i)) = motions.row(rows[i]);
  constexpr double roundOff = 1e-9;
  const Eigen::MatrixXd own =
      rows.empty() ? free : direct::orthogonalComplement(direct::pivotedColumns(free, roundOff).basis);
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(motions.rows(), rows.empty() ? 0 : own.cols());
  for (std::size_t i = 0; i < rows.size() && modes.cols() > 0; ++i)
    modes.row(rows[i]) = own.row(static_cast<Eigen::Index>(i));
  return modes;
}

/// How many there are at most.
Eigen::Index mostModes(const BoundCells& cells) {
  const Eigen::Index components = cells.components();
  return components * nodesPerFacet(cells.mesh().cellType()) - components * (components + 1) / 2;
}

struct FacetSide {
  FacetKey key;
  GlobalOrdinal element;
  std::size_t place;
  int facet;
};

bool hasNodeGroups(const BoundCells& cells) {
  return dimensionOf(cells.mesh().cellType()) == 2;
}

} // namespace

ModeGroups::ModeGroups(const std::vector<std::unique_ptr<BoundCells>>& cells,
                       const std::vector<BoundLoads>& loads, const RCP<const Comm>& comm)
    : cells_(cells), comm_(comm) {
  GlobalOrdinal first = 0;
  for (std::size_t b = 0; b < cells.size(); ++b) {
    const auto perElement = std::ssize(cells[b]->facets());
    most_ = std::max(most_, mostModes(*cells[b]));
    if (hasNodeGroups(*cells[b]))
      most_ = std::max<Eigen::Index>(most_, cells[b]->components() == 1 ? 1 : 3);
    OfCells& own = ofCells_.emplace_back(
        cells[b]->numOwn(), std::vector<std::size_t>((hasNodeGroups(*cells[b]) ? 2 : 1) * perElement));
    findFacets(*cells[b], loads[b], first, own);
    first += cells[b]->mesh().numElements() * perElement;
    if (!hasNodeGroups(*cells[b]))
      continue;
    findNodes(*cells[b], loads[b], first, own);
    first += cells[b]->mesh().numNodes();
  }
  std::vector<GlobalOrdinal> numbers;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    if (groups_[g].isShared) {
      shared_.push_back(g);
      numbers.push_back(groups_[g].number);
    }
  here_ = mapInOrder(numbers, comm);
  if (comm->getSize() > 1) {
    owned_ = Tpetra::createOneToOne(here_);
    plan_ = rcp(new Export(here_, owned_));
  }
}

void ModeGroups::findFacets(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first,
                            OfCells& own) {
  const int perElement = static_cast<int>(cells.facets().size());
  std::vector<FacetSide> sides;
  for (std::size_t place = 0; place < cells.number(); ++place)
    for (int k = 0; k < perElement; ++k)
      sides.push_back({cells.facetAt(place, k), cells.elementAt(place), place, k});
  std::sort(sides.begin(), sides.end(), [](const FacetSide& a, const FacetSide& b) {
    return std::tie(a.key, a.element) < std::tie(b.key, b.element);
  });
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const FacetSide& side = sides[s];
    const bool hasOther = s + 1 < sides.size() && sides[s + 1].key == side.key,
               isOwn = side.place < cells.numOwn(),
               isOtherOwn = hasOther && sides[s + 1].place < cells.numOwn();
    if (isOwn || isOtherOwn) {
      std::array<bool, 3> isFree{hasOther, hasOther, hasOther};
      if (const auto given = loads.facets.find(side.key); !hasOther && given != loads.facets.end())
        isFree = given->second.isHeld;
      groups_.push_back({first + side.element * perElement + side.facet, side.element,
                         hasOther && isOwn != isOtherOwn, isOwn, isFree});
      if (isOwn)
        own[side.place][side.facet] = groups_.size() - 1;
      if (isOtherOwn)
        own[sides[s + 1].place][sides[s + 1].facet] = groups_.size() - 1;
    }
    s += hasOther ? 1 : 0;
  }
}

/// Round a corner of elements the same force, or moment, may go from each to the next, if a support takes it
/// where there is none.
void ModeGroups::findNodes(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first,
                           OfCells& own) {
  const auto facets = cells.facets();
  const int perElement = static_cast<int>(facets.size());
  for (int node = 0; node < cells.numOwnNodes(); ++node) {
    const auto around = cells.around(node);
    if (around.empty() || around[0].node >= perElement)
      continue;
    std::array<bool, 2> isFree{true, true};
    std::vector<FacetKey> keys;
    GlobalOrdinal lowest = cells.elementAt(around[0].place);
    std::size_t ofLowest = around[0].place;
    bool isShared = false;
    for (const CellCorner& at : around) {
      isShared = isShared || at.place >= cells.numOwn();
      if (cells.elementAt(at.place) < lowest) {
        lowest = cells.elementAt(at.place);
        ofLowest = at.place;
      }
      for (int k = 0; k < perElement; ++k)
        if (facets[k][0] == at.node || facets[k][1] == at.node)
          keys.push_back(cells.facetAt(at.place, k));
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (k + 1 < keys.size() && keys[k + 1] == keys[k]) {
        ++k;
        continue;
      }
      const auto given = loads.facets.find(keys[k]);
      for (std::size_t c = 0; c < 2; ++c)
        isFree.at(c) = isFree.at(c) && given != loads.facets.end() && given->second.isHeld.at(c);
    }
    const bool isMembrane = cells.components() == 1;
    groups_.push_back({first + cells.nodeAt(node),
                       lowest,
                       isShared,
                       ofLowest < cells.numOwn(),
                       {isFree[0], !isMembrane && isFree[1], !isMembrane && isFree[0] && isFree[1]}});
    for (const CellCorner& at : around)
      if (at.place < cells.numOwn())
        own[at.place][perElement + at.node] = groups_.size() - 1;
  }
}

Eigen::MatrixXd ModeGroups::moments(std::size_t body, std::size_t place) const {
  const BoundCells& cells = *cells_[body];
  const auto facets = cells.facets();
  const auto groups = of(body, place);
  const auto nodes = cells.nodesAt(place);
  const Eigen::Index components = cells.components(), number = std::ssize(facets),
                     perFacet = std::ssize(facets[0]) * components;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(number * perFacet, most_ * std::ssize(groups));
  std::vector<Point> points;
  for (Eigen::Index k = 0; k < number; ++k) {
    const std::vector<int> order = ascending(facets[k], nodes);
    points.clear();
    for (const int i : order)
      points.push_back(cells.mesh().point(nodes[facets[k][i]]));
    const Group& group = groups_[groups[k]];
    // Of two elements one hands to the other.
    const double sign = group.element == cells.elementAt(place) ? 1 : -1;
    const Eigen::MatrixXd modes =
        facetModes(points, components, dimensionOf(cells.mesh().cellType()), group.isFree);
    for (std::size_t i = 0; i < order.size(); ++i)
      result.block(k * perFacet + order[i] * components, k * most_, components, modes.cols()) =
          sign * modes.middleRows(static_cast<Eigen::Index>(i) * components, components);
  }
  if (hasNodeGroups(cells))
    addNodeModes(body, place, result);
  return result;
}

/// Out of the element along the edge that leaves a corner, into it along the one that comes there.
void ModeGroups::addNodeModes(std::size_t body, std::size_t place, Eigen::MatrixXd& result) const {
  const BoundCells& cells = *cells_[body];
  const auto facets = cells.facets();
  const auto nodes = cells.nodesAt(place);
  const Eigen::Index components = cells.components(), number = std::ssize(facets),
                     perFacet = std::ssize(facets[0]) * components;
  for (Eigen::Index k = 0; k < number; ++k) {
    const mesh::Facet& facet = facets[k];
    const Point from = cells.mesh().point(nodes[facet[0]]), to = cells.mesh().point(nodes[facet[1]]);
    const Eigen::Vector2d along(to[0] - from[0], to[1] - from[1]);
    for (const int end : {0, 1}) {
      const double sign = end == 0 ? 1 : -1;
      const auto& isThere = groups_[of(body, place)[number + facet[end]]].isFree;
      auto own = result.block(k * perFacet, most_ * (number + facet[end]), perFacet, most_);
      for (Eigen::Index c = 0; c < components; ++c)
        if (isThere.at(c))
          own(end * components + c, c) = sign;
      if (components == 1 || !isThere[2])
        continue;
      const Eigen::Vector2d away = (end == 0 ? 1 : -1) * along / along.squaredNorm(), arm(-away[1], away[0]);
      own.block<2, 1>((1 - end) * components, 2) = sign * arm;
      own.block<2, 1>(end * components, 2) = -sign * arm;
    }
  }
}

double ModeGroups::dot(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const {
  AccurateSum sums[1];
  for (Eigen::Index e = 0; e < a.cols(); ++e)
    if (groups_[e].isOwned || !groups_[e].isShared)
      sums[0].add(a.col(e).dot(b.col(e)));
  sumOverRanks(*comm_, sums);
  return sums[0].value();
}

/// Collective.
void ModeGroups::sum(Eigen::MatrixXd& values) const {
  if (comm_->getSize() == 1)
    return;
  const auto rows = static_cast<std::size_t>(values.rows());
  MultiVector mine(here_, rows), sums(owned_, rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto data = mine.getDataNonConst(row);
    for (std::size_t k = 0; k < shared_.size(); ++k)
      data[static_cast<Teuchos::Ordinal>(k)] = values(row, shared_[k]);
  }
  sums.doExport(mine, *plan_, Tpetra::ADD);
  mine.doImport(sums, *plan_, Tpetra::REPLACE);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto data = mine.getData(row);
    for (std::size_t k = 0; k < shared_.size(); ++k)
      values(row, shared_[k]) = data[static_cast<Teuchos::Ordinal>(k)];
  }
}

} // namespace epafi::accuracy
