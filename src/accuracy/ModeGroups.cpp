#include "epafi/accuracy/ModeGroups.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Maps.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace epafi::accuracy {
namespace {

/// ∫ P N_a over [0, 1], P the Legendre polynomials of degree 1 and 2, a column each.
Eigen::MatrixXd legendreMoments(int order) {
  const mesh::Shape<1>& edge = mesh::referenceShape<1>(withOrder(mesh::CellType::line, order));
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(edge.numNodes, order);
  for (const auto& [along, weight] : fem::fourGauss) {
    const double x = 2 * along - 1;
    const Eigen::VectorXd values = weight * edge.values(mesh::Coordinates<1>(along));
    moments.col(0) += x * values;
    if (order == 2)
      moments.col(1) += 0.5 * (3 * x * x - 1) * values;
  }
  return moments;
}

/// Modes of an edge, a column each, from one of its elements, whose direction is the edge's (`sign` 1) or
/// not: moments of tractions at the edge's nodes.
Eigen::MatrixXd edgeModes(const Eigen::Vector2d& along, const Eigen::MatrixXd& legendre,
                          Eigen::Index components, double sign) {
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(components * legendre.rows(), ModeGroups::most);
  Eigen::Index mode = 0;
  const auto add = [&](Eigen::Index degree, const Eigen::VectorXd& direction) {
    // Against the other element, and the other way round along the edge.
    const double factor = sign * (degree == 0 ? sign : 1.0) * along.norm();
    Eigen::Map<Eigen::MatrixXd>(modes.col(mode++).data(), components, legendre.rows()) =
        factor * direction * legendre.col(degree).transpose();
  };
  if (components == 1)
    for (Eigen::Index degree = 0; degree < legendre.cols(); ++degree)
      add(degree, Eigen::VectorXd::Ones(1));
  else {
    add(0, sign * along.normalized());
    for (Eigen::Index c = 0; c < 2 && legendre.cols() == 2; ++c)
      add(1, Eigen::Vector2d::Unit(c));
  }
  return modes;
}

/// Which of them an edge may have. \param held  components in which the traction is free
std::array<bool, ModeGroups::most> freeModes(const Eigen::Vector2d& along, std::array<bool, 2> held,
                                             Eigen::Index components, int order) {
  if (components == 1)
    return {held[0], held[0] && order == 2, false};
  constexpr double roundOff = 1e-12;
  const Eigen::Vector2d tangent = along.normalized();
  const bool slides = (held[0] && held[1]) || (held[0] && std::abs(tangent[1]) < roundOff) ||
                      (held[1] && std::abs(tangent[0]) < roundOff);
  return {slides, held[0] && order == 2, held[1] && order == 2};
}

struct EdgeSide {
  EdgeKey key;
  GlobalOrdinal element;
  std::size_t place;
  int edge;
};

Eigen::Vector2d alongOf(const BoundCells& cells, std::size_t place, int edge) {
  const mesh::Facet& facet = facetsOf(cells.mesh().cellType())[edge];
  const auto nodes = cells.nodesAt(place);
  const Point from = cells.mesh().point(nodes[facet[0]]), to = cells.mesh().point(nodes[facet[1]]);
  return {to[0] - from[0], to[1] - from[1]};
}

} // namespace

ModeGroups::ModeGroups(const std::vector<std::unique_ptr<BoundCells>>& cells,
                       const std::vector<BoundLoads>& loads, const RCP<const Comm>& comm)
    : cells_(cells), comm_(comm), legendre_{legendreMoments(1), legendreMoments(2)} {
  GlobalOrdinal first = 0;
  for (std::size_t b = 0; b < cells.size(); ++b) {
    const auto perElement = std::ssize(facetsOf(cells[b]->mesh().cellType()));
    OfCells& own = ofCells_.emplace_back(cells[b]->numOwn(), std::vector<std::size_t>(2 * perElement));
    findEdges(*cells[b], loads[b], first, own);
    first += cells[b]->mesh().numElements() * perElement;
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

void ModeGroups::findEdges(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first,
                           OfCells& own) {
  const int perElement = static_cast<int>(facetsOf(cells.mesh().cellType()).size()),
            order = orderOf(cells.mesh().cellType());
  std::vector<EdgeSide> sides;
  for (std::size_t place = 0; place < cells.number(); ++place)
    for (int k = 0; k < perElement; ++k)
      sides.push_back({cells.edgeAt(place, k), cells.elementAt(place), place, k});
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return std::tie(a.key, a.element) < std::tie(b.key, b.element);
  });
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const EdgeSide& side = sides[s];
    const bool hasOther = s + 1 < sides.size() && sides[s + 1].key == side.key,
               isOwn = side.place < cells.numOwn(),
               isOtherOwn = hasOther && sides[s + 1].place < cells.numOwn();
    if (isOwn || isOtherOwn) {
      std::array<bool, 2> held{hasOther, hasOther};
      if (const auto given = loads.edges.find(side.key); !hasOther && given != loads.edges.end())
        held = given->second.isHeld;
      groups_.push_back({first + side.element * perElement + side.edge, hasOther && isOwn != isOtherOwn,
                         isOwn,
                         freeModes(alongOf(cells, side.place, side.edge), held, cells.components(), order)});
      if (isOwn)
        own[side.place][side.edge] = groups_.size() - 1;
      if (isOtherOwn)
        own[sides[s + 1].place][sides[s + 1].edge] = groups_.size() - 1;
    }
    s += hasOther ? 1 : 0;
  }
}

/// Round a corner of elements the same force, or moment, may go from each to the next, if a support takes it
/// where there is none.
void ModeGroups::findNodes(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first,
                           OfCells& own) {
  const auto facets = facetsOf(cells.mesh().cellType());
  const int perElement = static_cast<int>(facets.size());
  for (int node = 0; node < cells.numOwnNodes(); ++node) {
    const auto around = cells.around(node);
    if (around.empty() || around[0].node >= perElement)
      continue;
    std::array<bool, 2> isFree{true, true};
    std::vector<EdgeKey> keys;
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
          keys.push_back(cells.edgeAt(at.place, k));
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (k + 1 < keys.size() && keys[k + 1] == keys[k]) {
        ++k;
        continue;
      }
      const auto given = loads.edges.find(keys[k]);
      for (std::size_t c = 0; c < 2; ++c)
        isFree.at(c) = isFree.at(c) && given != loads.edges.end() && given->second.isHeld.at(c);
    }
    const bool isMembrane = cells.components() == 1;
    groups_.push_back({first + cells.nodeAt(node),
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
  const Eigen::MatrixXd& legendre = legendre_.at(orderOf(cells.mesh().cellType()) - 1);
  const auto facets = facetsOf(cells.mesh().cellType());
  const Eigen::Index components = cells.components(), perEdge = legendre.rows() * components,
                     number = std::ssize(facets);
  const auto nodes = cells.nodesAt(place);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(number * perEdge, most * 2 * number);
  for (Eigen::Index k = 0; k < number; ++k) {
    const mesh::Facet& facet = facets[k];
    const Eigen::Vector2d along = alongOf(cells, place, static_cast<int>(k));
    result.block(k * perEdge, k * most, perEdge, most) =
        edgeModes(along, legendre, components, nodes[facet[0]] < nodes[facet[1]] ? 1 : -1);
    // Out of the element along the edge that leaves a corner, into it along the one that comes there.
    for (const int end : {0, 1}) {
      const double sign = end == 0 ? 1 : -1;
      auto own = result.block(k * perEdge, most * (number + facet[end]), perEdge, most);
      own.block(end * components, 0, components, components) =
          sign * Eigen::MatrixXd::Identity(components, components);
      if (components == 1)
        continue;
      const Eigen::Vector2d away = (end == 0 ? 1 : -1) * along / along.squaredNorm(), arm(-away[1], away[0]);
      own.block<2, 1>((1 - end) * components, 2) = sign * arm;
      own.block<2, 1>(end * components, 2) = -sign * arm;
    }
  }
  for (Eigen::Index g = 0; g < 2 * number; ++g)
    for (Eigen::Index m = 0; m < most; ++m)
      if (!has(of(body, place)[g], m))
        result.col(g * most + m).setZero();
  return result;
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
