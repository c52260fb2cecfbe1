// Rows of friction at nodes that supports hold, in planes of symmetry above all.

#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/contact/SymmetryPlanes.hpp"

#include <Eigen/Geometry>
#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace {

using namespace epafi;
using contact::ContactLayout;
using contact::NodeUnknowns;
using Eigen::Vector3d;

constexpr GlobalOrdinal numNodes = 2; // of each body: node 0 in the plane x = 0, node 1 beside it

/// What supports hold.
struct Held {
  std::vector<int> first, second; ///< components of node 0 of each body
  [[nodiscard]] bool operator()(int body, GlobalOrdinal node, int component) const {
    const std::vector<int>& held = body == 0 ? first : second;
    return node == 0 && std::find(held.begin(), held.end(), component) != held.end();
  }
};

/// In space, on one rank.
NodeUnknowns unknownsOf(const Held& held) {
  NodeUnknowns unknowns;
  unknowns.components = 3;
  unknowns.firstNode = {0, numNodes};
  unknowns.frame = [](int, GlobalOrdinal) -> const Eigen::Matrix3d* { return nullptr; };
  unknowns.isHeld = held;
  unknowns.isMine = [](int, GlobalOrdinal) { return true; };
  return unknowns;
}

/// Rows of two nodes, each moving both, as by mortars, against two nodes of another body. The normal of the
/// first leaves the plane x = 0 by what its facets' mean is off.
ContactLayout beside(double off, const Held& held, double facingAt = 0) {
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
  const auto own = [](GlobalOrdinal node) { return Point{node == 0 ? 0.0 : 1.0, 0.0, 0.0}; };
  const auto other = [=](GlobalOrdinal node) { return Point{node == 0 ? facingAt : 1.2, 0.1, 0.0}; };
  const auto axes = [=](int body, GlobalOrdinal node) {
    std::vector<Vector3d> result;
    for (int c = 0; c < 3; ++c)
      if (held(body, node, c))
        result.emplace_back(Vector3d::Unit(c));
    return result;
  };
  findSymmetryPlanes(own, other, axes, contact);
  return contact;
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
    const Held held{{0}, {0}};
    const std::vector<ContactLayout> contacts{beside(off, held)};
    ASSERT_EQ(contacts[0].symmetryPlanes.size(), 2U) << off;
    const NodeUnknowns unknowns = unknownsOf(held);
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
      EXPECT_NEAR(tangent.norm(), isFree ? 1 : 0, 1e-14) << off;
      for (const GlobalOrdinal node : {0, 1, 2, 3}) // a row across moves no node around
        EXPECT_EQ(freePart(unknowns, node, motions[node]).norm() > 0, isFree) << off << ", node " << node;
      const double moved = (motions[0] + motions[2]).norm(); // by a plane that moves
      EXPECT_TRUE(isFree || moved < 1e-14) << off;
    }
    EXPECT_EQ(numFree, 1) << off;
  }
}

/// A slope, a surface that may slide, one that is held elsewhere, a clamp: no plane of symmetry.
TEST(FrictionRowsTest, WhatIsHeldOtherwiseKeepsItsRows) {
  struct Case {
    double off;
    Held held;
    double facingAt;
  };
  for (const Case& each : {Case{0.5, {{0}, {0}}, 0}, Case{0.05, {{0}, {}}, 0}, Case{0.05, {{0}, {1}}, 0},
                           Case{0.05, {{0}, {0}}, 0.01}, Case{0.05, {{0, 1, 2}, {0, 1, 2}}, 0}}) {
    const ContactLayout layout = beside(each.off, each.held, each.facingAt);
    EXPECT_TRUE(layout.symmetryPlanes.empty());
    const auto friction = contact::frictionRows({layout}, unknownsOf(each.held), Tpetra::getDefaultComm());
    for (const GlobalOrdinal row : {0, 1}) {
      const auto motions = motionsOf(*friction.tangents.rows, row);
      EXPECT_NEAR(motions[1].norm(), 0.25, 1e-14);
      EXPECT_NEAR(motions[3].norm(), 0.5, 1e-14);
    }
    const contact::ContactTangents tangents(layout);
    for (const std::size_t place : {0, 1}) {
      const auto [first, second] = tangents.at(place);
      EXPECT_NEAR(first.dot(layout.directionAt(place)), 0, 1e-14);
      EXPECT_NEAR(second.dot(layout.directionAt(place)), 0, 1e-14);
      EXPECT_NEAR(first.dot(second), 0, 1e-14);
      EXPECT_NEAR(first.norm() * second.norm(), 1, 1e-14);
    }
  }
}

TEST(FrictionRowsTest, APlaneIsOneInWhichTheFacingNodeLiesToo) {
  const ContactLayout layout = beside(0.25, {{0, 1}, {0, 1}});
  ASSERT_EQ(layout.symmetryPlanes.size(), 2U);
  EXPECT_EQ(layout.symmetryPlanes[0].size(), 1U); // y = 0.1 there
  EXPECT_NEAR(layout.slidingNormalAt(0)[0], 0, 1e-15);
}

} // namespace
