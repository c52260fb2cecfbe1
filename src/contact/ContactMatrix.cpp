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
/// Coefficients that would be 0 without round-off of normals and frames.
constexpr double roundOffOfDirection = 1e-14;

/// A row of B.
struct MatrixRow {
  GlobalOrdinal number;
  double gap;
  std::vector<GlobalOrdinal> unknowns;
  std::vector<double> coefficients;
};

/// Whether supports hold a node along d, given in its unknowns.
bool isHeldAlong(const Eigen::Vector3d& direction, const NodeUnknowns& unknowns, int body,
                 GlobalOrdinal node) {
  double free = 0;
  for (int c = 0; c < unknowns.components; ++c)
    if (!unknowns.isHeld(body, node, c))
      free = std::hypot(free, direction[c]);
  return free <= heldDirection;
}

/// d in the unknowns of a node: its components, or Qᵀd where it has a frame Q.
Eigen::Vector3d inUnknowns(const Eigen::Vector3d& direction, const NodeUnknowns& unknowns, int body,
                           GlobalOrdinal node) {
  const Eigen::Matrix3d* frame = unknowns.frame(body, node);
  return frame != nullptr ? Eigen::Vector3d(frame->transpose() * direction) : direction;
}

/// Which nodes of a row count.
enum class Entries { all, heldOnes };

/// Enters a node along d, times a factor.
void enter(const Eigen::Vector3d& direction, const NodeUnknowns& unknowns, int body, GlobalOrdinal node,
           double factor, Entries entries, MatrixRow& row) {
  const Eigen::Vector3d along = inUnknowns(direction, unknowns, body, node);
  const bool isHeld = isHeldAlong(along, unknowns, body, node);
  if (!isHeld && entries == Entries::heldOnes)
    return;
  for (int c = 0; c < unknowns.components; ++c)
    if (std::abs(along[c]) > roundOffOfDirection && (!isHeld || unknowns.isHeld(body, node, c))) {
      row.unknowns.push_back((unknowns.firstNode[body] + node) * unknowns.components + c);
      row.coefficients.push_back(factor * along[c]);
    }
}

/// Enters a row of a place along directionOf(node) at each of the nodes that it combines.
template <class DirectionOf>
void enterAlong(const ContactLayout& contact, std::size_t place, const NodeUnknowns& unknowns,
                Entries entries, const DirectionOf& directionOf, MatrixRow& row) {
  contact.forEachShare(place, [&](std::size_t node, double weight) {
    const Eigen::Vector3d direction = directionOf(node);
    contact.forEachFirst(node, [&](const NodeShare& share) {
      enter(direction, unknowns, contact.firstBody, share.node, weight * share.weight, entries, row);
    });
    if (contact.secondBody >= 0)
      for (const NodeShare& share : contact.secondNodes[node])
        enter(direction, unknowns, contact.secondBody, share.node, -weight * share.weight, entries, row);
  });
}

/// Where supports hold a row's own node along a tangent, and what it faces, as in a plane of symmetry, there
/// is no slip that a force could hinder: what the row has of nodes around is none of its own.
Entries entriesAlong(const Eigen::Vector3d& tangent, const ContactLayout& contact, std::size_t place,
                     const NodeUnknowns& unknowns) {
  const auto isHeld = [&](int body, GlobalOrdinal node) {
    return isHeldAlong(inUnknowns(tangent, unknowns, body, node), unknowns, body, node);
  };
  if (!isHeld(contact.firstBody, contact.firstNodes[place]))
    return Entries::all;
  if (contact.secondBody < 0)
    return Entries::heldOnes;
  const std::vector<NodeShare>& facing = contact.secondNodes[place];
  return std::any_of(facing.begin(), facing.end(),
                     [&](const NodeShare& share) { return isHeld(contact.secondBody, share.node); })
             ? Entries::heldOnes
             : Entries::all;
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
}

std::array<Eigen::Vector3d, 2> ContactTangents::at(std::size_t place) const {
  const Eigen::Vector3d normal = contact_.slidingNormalAt(place);
  if (contact_.numComponents() < 3)
    return decomposition::tangentsOf(normal);
  constexpr double clearlyApart = 0.1;
  const Eigen::Vector3d across = normal.cross(axis_);
  if (across.norm() < clearlyApart)
    return decomposition::tangentsOf(normal);
  const Eigen::Vector3d first = across.normalized();
  return {first, normal.cross(first)};
}

decomposition::ConstraintMatrix contactMatrix(const std::vector<ContactLayout>& contacts,
                                              const NodeUnknowns& unknowns, const RCP<const Comm>& comm) {
  std::vector<MatrixRow> rows;
  forEachOwnRow(contacts, unknowns, [&](const ContactLayout& contact, std::size_t place) {
    MatrixRow& row =
        rows.emplace_back(MatrixRow{contact.firstRow + static_cast<GlobalOrdinal>(place), 0, {}, {}});
    contact.forEachShare(place,
                         [&](std::size_t node, double weight) { row.gap += weight * contact.gaps[node]; });
    enterAlong(
        contact, place, unknowns, Entries::all, [&](std::size_t node) { return contact.directionAt(node); },
        row);
    if (!contact.secondLevers.empty())
      for (const NodeForce& lever : contact.secondLevers[place])
        if (const double size = lever.force.norm(); size > 0)
          enter(lever.force / size, unknowns, contact.secondBody, lever.node, -size, Entries::all, row);
  });
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
    for (GlobalOrdinal k = 0; k < numTangents; ++k) {
      const Eigen::Vector3d tangent = frames.at(place)[k];
      const Entries entries = entriesAlong(tangent, contact, place, unknowns);
      MatrixRow& row =
          rows.emplace_back(MatrixRow{numTangents * (contact.firstFriction + offset) + k, 0, {}, {}});
      enterAlong(
          contact, place, unknowns, entries, [&](std::size_t node) { return frames.at(node)[k]; }, row);
      if (row.unknowns.empty()) // of no node that it combines: its own stands for what is held
        enter(tangent, unknowns, contact.firstBody, contact.firstNodes[place], 1, entries, row);
    }
  });
  result.tangents = matrixOf(rows, comm);
  return result;
}

} // namespace epafi::contact
