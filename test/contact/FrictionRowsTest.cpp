// Rows of friction at nodes that supports hold.

#include "epafi/contact/ContactMatrix.hpp"

#include <Eigen/Geometry>
#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace {

using namespace epafi;
using contact::ContactLayout;
using contact::NodeUnknowns;
using Eigen::Vector3d;

constexpr GlobalOrdinal numNodes = 2; // of each body: node 0 in the plane x = 0, node 1 beside it

/// Rows of two nodes, each moving both, as by mortars, against two nodes of another body. The normal of the
/// first leaves the plane x = 0 by what its facets' mean is off.
ContactLayout beside(double off) {
  ContactLayout contact;
  contact.firstFriction = 0;
  contact.secondBody = 1;
  contact.firstNodes = {0, 1};
  for (const Vector3d& normal : {Vector3d(off, 0.2, -1).normalized(), Vector3d(0.1, 0.2, -1).normalized()})
    contact.directions.insert(contact.directions.end(), {normal[0], normal[1], normal[2]});
  contact.gaps = {0, 0};
  contact.areas = {1, 1};
  contact.firstShares = {{{0, 1.0}, {1, 0.25}}, {{1, 1.0}, {0, 0.25}}};
  contact.secondNodes = {{{0, 0.75}, {1, 0.5}}, {{0, 0.25}, {1, 1.0}}};
  const Vector3d first = contact.directionAt(0), second = contact.directionAt(1);
  contact.slidingNormals = {Vector3d(0, first[1], first[2]).normalized(), second};
  return contact;
}

/// In space, one rank; supports hold nodes 0 along x: of both bodies, or of the first alone.
NodeUnknowns inPlane(bool isSecondHeld) {
  NodeUnknowns unknowns;
  unknowns.components = 3;
  unknowns.firstNode = {0, numNodes};
  unknowns.frame = [](int, GlobalOrdinal) -> const Eigen::Matrix3d* { return nullptr; };
  unknowns.isHeld = [isSecondHeld](int body, GlobalOrdinal node, int component) {
    return node == 0 && component == 0 && (body == 0 || isSecondHeld);
  };
  unknowns.isMine = [](int, GlobalOrdinal) { return true; };
  return unknowns;
}

/// A row as it moves each of the four nodes.
std::array<Vector3d, 2 * numNodes> motionsOf(const CrsMatrix& matrix, GlobalOrdinal row) {
  std::array<Vector3d, 2 * numNodes> motions;
  motions.fill(Vector3d::Zero());
  typename CrsMatrix::local_inds_host_view_type columns;
  typename CrsMatrix::values_host_view_type values;
  matrix.getLocalRowView(matrix.getRowMap()->getLocalElement(row), columns, values);
  for (std::size_t k = 0; k < columns.extent(0); ++k) {
    const GlobalOrdinal unknown = matrix.getColMap()->getGlobalElement(columns(k));
    motions[unknown / 3][unknown % 3] += values(k);
  }
  return motions;
}

/// The same without what supports hold.
Vector3d freePart(const NodeUnknowns& unknowns, GlobalOrdinal node, Vector3d motion) {
  for (int c = 0; c < 3; ++c)
    if (unknowns.isHeld(node < numNodes ? 0 : 1, node % numNodes, c))
      motion[c] = 0;
  return motion;
}

TEST(FrictionRowsTest, InAPlaneOfSymmetryTangentsHinderNoApproach) {
  for (const double off : {0.0, 1e-4, 0.05, -0.2}) {
    const std::vector<ContactLayout> contacts{beside(off)};
    const NodeUnknowns unknowns = inPlane(true);
    const auto contact = contact::contactMatrix(contacts, unknowns, Tpetra::getDefaultComm());
    const auto friction = contact::frictionRows(contacts, unknowns, Tpetra::getDefaultComm());
    const Vector3d normal = freePart(unknowns, 0, motionsOf(*contact.rows, 0)[0]);
    int numFree = 0;
    for (const GlobalOrdinal row : {0, 1}) {
      const auto motions = motionsOf(*friction.tangents.rows, row);
      const Vector3d tangent = freePart(unknowns, 0, motions[0]);
      EXPECT_NEAR(tangent.dot(normal), 0, 1e-14) << off;
      const bool isFree = tangent.norm() > 0;
      numFree += isFree ? 1 : 0;
      if (isFree)
        EXPECT_NEAR(tangent.norm(), 1, 1e-14) << off;
      for (const GlobalOrdinal node : {0, 1, 2, 3}) // what is held there moves no node around
        EXPECT_EQ(freePart(unknowns, node, motions[node]).norm() > 0, isFree) << off << ", node " << node;
    }
    EXPECT_EQ(numFree, 1) << off;
  }
}

TEST(FrictionRowsTest, WhereTheOtherSurfaceMayMoveItIsHindered) {
  const std::vector<ContactLayout> contacts{beside(0.05)};
  const NodeUnknowns unknowns = inPlane(false);
  const auto friction = contact::frictionRows(contacts, unknowns, Tpetra::getDefaultComm());
  for (const GlobalOrdinal row : {0, 1}) {
    const auto motions = motionsOf(*friction.tangents.rows, row);
    EXPECT_NEAR(motions[2].norm(), 0.75, 1e-14);
    EXPECT_NEAR(motions[3].norm(), 0.5, 1e-14);
  }
}

TEST(FrictionRowsTest, ElsewhereTheyArePerpendicularToTheContact) {
  ContactLayout layout = beside(0.05);
  layout.slidingNormals.clear();
  const contact::ContactTangents tangents(layout);
  for (const std::size_t place : {0, 1}) {
    const auto [first, second] = tangents.at(place);
    EXPECT_NEAR(first.dot(layout.directionAt(place)), 0, 1e-14);
    EXPECT_NEAR(second.dot(layout.directionAt(place)), 0, 1e-14);
    EXPECT_NEAR(first.dot(second), 0, 1e-14);
    EXPECT_NEAR(first.norm() * second.norm(), 1, 1e-14);
  }
}

} // namespace
