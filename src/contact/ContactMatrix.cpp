#include "epafi/contact/ContactMatrix.hpp"

#include "epafi/base/Maps.hpp"

#include <Eigen/Geometry>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace epafi::contact {
namespace {

/// A node that can move in a row's direction by no more than this share of what it is moved by does not count
/// in it: the rest is round-off of normals.
constexpr double heldDirection = 1e-6;
constexpr double clearlyApart = 0.1; ///< sine of an angle between axes
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

/// Enters a row of a place along directionOf(node) at each of the nodes that it combines.
template <class DirectionOf>
void enterAlong(const ContactLayout& contact, std::size_t place, const NodeUnknowns& unknowns,
                const DirectionOf& directionOf, MatrixRow& row) {
  contact.forEachShare(place, [&](std::size_t node, double weight) {
    const Eigen::Vector3d direction = directionOf(node);
    contact.forEachFirst(node, [&](const NodeShare& share) {
      enter(direction, unknowns, contact.firstBody, share.node, weight * share.weight, row);
    });
    if (contact.secondBody >= 0)
      for (const NodeShare& share : contact.secondNodes[node])
        enter(direction, unknowns, contact.secondBody, share.node, -weight * share.weight, row);
  });
}

/// The plane of symmetry of a place across which a tangent is; null: it is across none.
const SymmetryPlane* planeAcross(const Eigen::Vector3d& tangent, const ContactLayout& contact,
                                 std::size_t place) {
  constexpr double parallel = 1 - 1e-9; // least cosine
  if (!contact.symmetryPlanes.empty())
    for (const SymmetryPlane& plane : contact.symmetryPlanes[place])
      if (std::abs(tangent.dot(plane.normal)) > parallel)
        return &plane;
  return nullptr;
}

/// Enters a row of friction along the tangents that `frames` has of each node. Across a plane of symmetry
/// tractions are odd, none in the plane, and nothing slips: what the row would have of nodes around is left
/// out, and the rest is what supports hold.
void enterFriction(const ContactLayout& contact, std::size_t place, const NodeUnknowns& unknowns,
                   const ContactTangents& frames, GlobalOrdinal k, MatrixRow& row) {
  const Eigen::Vector3d tangent = frames.at(place)[k];
  if (const SymmetryPlane* plane = planeAcross(tangent, contact, place)) {
    enter(tangent, unknowns, contact.firstBody, contact.firstNodes[place], 1, row);
    enter(tangent, unknowns, contact.secondBody, plane->facing, -1, row);
    return;
  }
  enterAlong(
      contact, place, unknowns, [&](std::size_t node) { return frames.at(node)[k]; }, row);
}

/// action(contact, place) for the rows that this rank owns, ascending.
template <class Action>
void forEachOwnRow(const std::vector<ContactLayout>& contacts, const NodeUnknowns& unknowns,
                   const Action& action) {
  for (const ContactLayout& contact : contacts)
    for (std::size_t place = 0; contact.hasOwnRows && place < contact.firstNodes.size(); ++place)
      if (unknowns.isMine(contact.firstBody, contact.firstNodes[place]))
        action(contact, place);
}

/// Collective.
decomposition::ConstraintMatrix matrixOf(const std::vector<MatrixRow>& rows, const RCP<const Comm>& comm) {
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

} // namespace

ContactTangents::ContactTangents(const ContactLayout& contact) : contact_(contact) {
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero(); // of all d to each axis
  for (std::size_t place = 0; place < contact.firstNodes.size(); ++place)
    nearest = nearest.cwiseMax(contact.slidingNormalAt(place).cwiseAbs());
  Eigen::Index farthest = 0;
  nearest.minCoeff(&farthest);
  axis_ = Eigen::Vector3d::Unit(farthest);
  for (const std::vector<SymmetryPlane>& planes : contact.symmetryPlanes)
    for (const SymmetryPlane& plane : planes)
      if (isApart(plane.normal)) {
        axis_ = plane.normal;
        return;
      }
}

/// Whether an axis is clearly another direction than all d.
bool ContactTangents::isApart(const Eigen::Vector3d& axis) const {
  for (std::size_t place = 0; place < contact_.firstNodes.size(); ++place)
    if (contact_.slidingNormalAt(place).cross(axis).norm() < clearlyApart)
      return false;
  return true;
}

std::array<Eigen::Vector3d, 2> ContactTangents::at(std::size_t place) const {
  const Eigen::Vector3d normal = contact_.slidingNormalAt(place);
  if (contact_.numComponents() < 3)
    return decomposition::tangentsOf(normal);
  const Eigen::Vector3d across = normal.cross(axis_);
  if (across.norm() < clearlyApart)
    return decomposition::tangentsOf(normal);
  const Eigen::Vector3d first = across.normalized();
  return {first, normal.cross(first)};
}

decomposition::ConstraintMatrix contactMatrix(const std::vector<ContactLayout>& contacts,
                                              const NodeUnknowns& unknowns, const RCP<const Comm>& comm,
                                              const std::vector<Equation>& equations) {
  std::vector<MatrixRow> rows;
  forEachOwnRow(contacts, unknowns, [&](const ContactLayout& contact, std::size_t place) {
    MatrixRow& row =
        rows.emplace_back(MatrixRow{contact.firstRow + static_cast<GlobalOrdinal>(place), 0, {}, {}});
    contact.forEachShare(place,
                         [&](std::size_t node, double weight) { row.gap += weight * contact.gaps[node]; });
    enterAlong(
        contact, place, unknowns, [&](std::size_t node) { return contact.directionAt(node); }, row);
    if (!contact.secondLevers.empty())
      for (const NodeForce& lever : contact.secondLevers[place])
        if (const double size = lever.force.norm(); size > 0)
          enter(lever.force / size, unknowns, contact.secondBody, lever.node, -size, row);
  });
  GlobalOrdinal next = 0;
  for (const ContactLayout& contact : contacts)
    next += contact.hasOwnRows ? contact.numRows() : 0;
  for (const Equation& equation : equations) {
    const GlobalOrdinal number = next++;
    if (!unknowns.isMine(equation.terms.front().body, equation.terms.front().node))
      continue;
    MatrixRow& row = rows.emplace_back(MatrixRow{number, equation.value, {}, {}});
    for (const Equation::Term& term : equation.terms)
      enter(term.direction.normalized(), unknowns, term.body, term.node, term.direction.norm(), row);
  }
  return matrixOf(rows, comm);
}

decomposition::FrictionRows frictionRows(const std::vector<ContactLayout>& contacts,
                                         const NodeUnknowns& unknowns, const RCP<const Comm>& comm) {
  const GlobalOrdinal numTangents = unknowns.components - 1;
  decomposition::FrictionRows result;
  std::vector<MatrixRow> rows;
  std::map<GlobalOrdinal, ContactTangents> tangents;
  forEachOwnRow(contacts, unknowns, [&](const ContactLayout& contact, std::size_t place) {
    if (contact.firstFriction < 0)
      return;
    const ContactTangents& frames = tangents.try_emplace(contact.firstRow, contact).first->second;
    const GlobalOrdinal offset = place;
    result.contactRows.push_back(contact.firstRow + offset);
    for (GlobalOrdinal k = 0; k < numTangents; ++k)
      enterFriction(
          contact, place, unknowns, frames, k,
          rows.emplace_back(MatrixRow{numTangents * (contact.firstFriction + offset) + k, 0, {}, {}}));
  });
  result.tangents = matrixOf(rows, comm);
  return result;
}

} // namespace epafi::contact
