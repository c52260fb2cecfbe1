#include "epafi/contact/ContactMatrix.hpp"

#include "epafi/base/Maps.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::contact {
namespace {

/// A node that can move in a row's direction by no more than this share of what it is moved by does not count
/// in it: the rest is round-off of normals.
constexpr double heldDirection = 1e-6;
/// Coefficients that would be 0 without round-off of normals and frames.
constexpr double roundOffOfDirection = 1e-14;

/// A row of B.
struct MatrixRow {
  GlobalOrdinal number;
  double gap;
  std::vector<GlobalOrdinal> unknowns;
  std::vector<double> coefficients;
};

/// Enters a node along d, times a factor, in its unknowns: its components, or Qᵀd where it has a frame Q.
void enter(Eigen::Vector3d direction, const NodeUnknowns& unknowns, int body, GlobalOrdinal node,
           double factor, MatrixRow& row) {
  if (const Eigen::Matrix3d* frame = unknowns.frame(body, node))
    direction = frame->transpose() * direction;
  double free = 0;
  for (int c = 0; c < unknowns.components; ++c)
    if (!unknowns.isHeld(body, node, c))
      free = std::hypot(free, direction[c]);
  for (int c = 0; c < unknowns.components; ++c)
    if (std::abs(direction[c]) > roundOffOfDirection &&
        (free > heldDirection || unknowns.isHeld(body, node, c))) {
      row.unknowns.push_back((unknowns.firstNode[body] + node) * unknowns.components + c);
      row.coefficients.push_back(factor * direction[c]);
    }
}

/// The rows that this rank owns, ascending.
std::vector<MatrixRow> ownRows(const std::vector<ContactLayout>& contacts, const NodeUnknowns& unknowns) {
  std::vector<MatrixRow> rows;
  for (const ContactLayout& contact : contacts)
    for (std::size_t place = 0; contact.hasOwnRows && place < contact.firstNodes.size(); ++place) {
      if (!unknowns.isMine(contact.firstBody, contact.firstNodes[place]))
        continue;
      MatrixRow& row =
          rows.emplace_back(MatrixRow{contact.firstRow + static_cast<GlobalOrdinal>(place), 0, {}, {}});
      contact.forEachShare(place, [&](std::size_t node, double weight) {
        const Eigen::Vector3d direction = contact.directionAt(node);
        row.gap += weight * contact.gaps[node];
        contact.forEachFirst(node, [&](const NodeShare& share) {
          enter(direction, unknowns, contact.firstBody, share.node, weight * share.weight, row);
        });
        if (contact.secondBody >= 0)
          for (const NodeShare& share : contact.secondNodes[node])
            enter(direction, unknowns, contact.secondBody, share.node, -weight * share.weight, row);
      });
      if (!contact.secondLevers.empty())
        for (const NodeForce& lever : contact.secondLevers[place])
          if (const double size = lever.force.norm(); size > 0)
            enter(lever.force / size, unknowns, contact.secondBody, lever.node, -size, row);
    }
  return rows;
}

} // namespace

decomposition::ConstraintMatrix contactMatrix(const std::vector<ContactLayout>& contacts,
                                              const NodeUnknowns& unknowns, const RCP<const Comm>& comm) {
  const std::vector<MatrixRow> rows = ownRows(contacts, unknowns);
  std::vector<GlobalOrdinal> numbers, columns;
  std::size_t longest = 0;
  for (const MatrixRow& row : rows) {
    numbers.push_back(row.number);
    columns.insert(columns.end(), row.unknowns.begin(), row.unknowns.end());
    longest = std::max(longest, row.unknowns.size());
  }
  const RCP<const Map> map = mapInOrder(numbers, comm);
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(map, longest));
  const RCP<Vector> gap = rcp(new Vector(map));
  for (const MatrixRow& row : rows) {
    matrix->insertGlobalValues(row.number, Teuchos::arrayViewFromVector(row.unknowns),
                               Teuchos::arrayViewFromVector(row.coefficients));
    gap->replaceGlobalValue(row.number, row.gap);
  }
  matrix->fillComplete(Tpetra::createOneToOne(makeMap(std::move(columns), comm)), map);
  return {matrix, gap, {}};
}

} // namespace epafi::contact
