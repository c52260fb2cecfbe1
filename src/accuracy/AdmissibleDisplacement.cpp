#include "epafi/accuracy/AdmissibleDisplacement.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::accuracy {
namespace {

/// At the nodes of own cells, a column each.
using NodalValues = Eigen::MatrixXd;

/// Means of what the elements around each node have, and what supports prescribe.
NodalValues meansOf(const BoundCells& cells, const Eigen::MatrixXd& displacements) {
  const Eigen::Index components = cells.components();
  NodalValues values = NodalValues::Zero(components, cells.numOwnNodes());
  std::vector<std::pair<GlobalOrdinal, int>> nodes;
  for (int node = 0; node < cells.numOwnNodes(); ++node) {
    for (const CellCorner& at : cells.around(node))
      values.col(node) += displacements.col(at.place).segment(at.node * components, components);
    values.col(node) /= static_cast<double>(cells.around(node).size());
    nodes.emplace_back(cells.nodeAt(node), node);
  }
  std::sort(nodes.begin(), nodes.end());
  std::vector<GlobalOrdinal> ascending;
  for (const auto& [number, node] : nodes)
    ascending.push_back(number);
  std::vector<fem::PrescribedValue> prescribed;
  cells.model().prescribed(ascending, prescribed);
  for (const auto& [position, value, support] : prescribed)
    values(static_cast<Eigen::Index>(position) % components,
           nodes[position / static_cast<std::size_t>(components)].second) = value;
  return values;
}

/// What is left of the gap at each row. Ranks that have a node have the same value. Collective.
std::vector<double> slackOf(const std::vector<std::unique_ptr<BoundCells>>& cells,
                            const std::vector<NodalValues>& values, const ContactPressure& contact,
                            const RCP<const Comm>& comm) {
  const std::size_t numRows = contact.gaps().size();
  std::vector<double> sums(4 * numRows, 0.0); // jump and number of ranks, of both sides
  std::vector<char> isSeen(2 * numRows, 0);
  for (const ContactFacet& facet : contact.facets())
    for (std::size_t i = 0; i < facet.rows.size(); ++i)
      for (const std::size_t side : {0U, 1U}) {
        if (side == 1 && facet.second < 0)
          continue;
        const std::size_t row = facet.rows[i];
        const int body = side == 0 ? facet.first : facet.second;
        const int node = cells[body]->localOf(side == 0 ? facet.nodes[i] : facet.facing[i]);
        if (node < 0 || isSeen[2 * row + side] != 0)
          continue;
        isSeen[2 * row + side] = 1;
        sums[4 * row + 2 * side] = facet.direction.dot(values[body].col(node));
        sums[4 * row + 2 * side + 1] = 1;
      }
  sumOverRanks(*comm, std::span(sums));
  std::vector<double> slack(contact.gaps().begin(), contact.gaps().end());
  for (std::size_t row = 0; row < numRows; ++row)
    for (const std::size_t side : {0U, 1U})
      if (const double number = sums[4 * row + 2 * side + 1]; number > 0)
        slack[row] += (side == 0 ? -1 : 1) * sums[4 * row + 2 * side] / number;
  return slack;
}

/// Of the nodes of each body's own cells, a column a cell.
std::vector<Eigen::MatrixXd> atCells(const std::vector<std::unique_ptr<BoundCells>>& cells,
                                     const std::vector<NodalValues>& values) {
  std::vector<Eigen::MatrixXd> result;
  for (std::size_t b = 0; b < cells.size(); ++b) {
    const Eigen::Index components = cells[b]->components();
    Eigen::MatrixXd& own =
        result.emplace_back(cells[b]->mesh().nodesPerElement() * components, cells[b]->numOwn());
    for (std::size_t place = 0; place < cells[b]->numOwn(); ++place) {
      const auto nodes = cells[b]->localsAt(place);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        own.col(place).segment(static_cast<Eigen::Index>(a) * components, components) =
            values[b].col(nodes[a]);
    }
  }
  return result;
}

/// Whether a support holds a node along a direction.
bool isHeld(const BoundCells& cells, GlobalOrdinal node, const Eigen::VectorXd& direction) {
  for (int c = 0; c < direction.size(); ++c)
    if (direction[c] != 0 && cells.model().prescribed(node, c))
      return true;
  return false;
}

} // namespace

AdmissibleDisplacement admissibleDisplacement(const std::vector<std::unique_ptr<BoundCells>>& cells,
                                              const ContactPressure& contact, const RCP<const Comm>& comm,
                                              const std::vector<Eigen::MatrixXd>& displacements) {
  AdmissibleDisplacement result;
  std::vector<NodalValues> values;
  for (std::size_t b = 0; b < cells.size(); ++b)
    values.push_back(meansOf(*cells[b], displacements[b]));
  result.means = atCells(cells, values);
  const std::vector<double> lack = contact.lacking(slackOf(cells, values, contact, comm));
  std::vector<char> isDone(lack.size(), 0);
  for (const ContactFacet& facet : contact.facets())
    for (std::size_t i = 0; i < facet.rows.size(); ++i) {
      const std::size_t row = facet.rows[i];
      if (lack[row] == 0 || isDone[row] != 0)
        continue;
      isDone[row] = 1;
      const bool firstMoves = !isHeld(*cells[facet.first], facet.nodes[i], facet.direction),
                 secondMoves =
                     facet.second >= 0 && !isHeld(*cells[facet.second], facet.facing[i], facet.direction);
      if (!firstMoves && !secondMoves)
        result.failure = "bodies penetrate between nodes where supports hold both of them";
      const Eigen::VectorXd way = (firstMoves && secondMoves ? 0.5 : 1.0) * lack[row] * facet.direction;
      if (const int node = cells[facet.first]->localOf(facet.nodes[i]); firstMoves && node >= 0)
        values[facet.first].col(node) -= way;
      if (!secondMoves)
        continue;
      if (const int node = cells[facet.second]->localOf(facet.facing[i]); node >= 0)
        values[facet.second].col(node) += way;
    }
  result.slack = slackOf(cells, values, contact, comm);
  double largest = 0;
  for (const NodalValues& body : values)
    if (body.size() > 0)
      largest = std::max(largest, body.lpNorm<Eigen::Infinity>());
  constexpr double roundOff = 1e-12;
  largest = maxOverRanks(*comm, largest);
  for (const double rest : contact.lacking(result.slack))
    if (!(rest <= roundOff * largest))
      result.failure = "several contacts meet at one node, and one's correction makes another penetrate";
  result.values = atCells(cells, values);
  return result;
}

} // namespace epafi::accuracy
