// Mortars: rows whose forces balance on both sides, in sum and in moment, whose functions are dual, and which
// say of any displacement that both sides share that nothing opens.

#include "epafi/contact/MortarRows.hpp"
#include "epafi/contact/ConvexPolygon.hpp"
#include "epafi/contact/RigidLinks.hpp"

#include "support/Refusal.hpp"
#include "support/SampleCells.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string>

namespace epafi::contact {
namespace {

using namespace test;

using Eigen::Vector3d;

const HeldNodes nothingIsHeld = [](GlobalOrdinal, const Vector3d&) { return false; };

Vector3d vectorOf(const Point& x) {
  return {x[0], x[1], x[2]};
}

/// Two bodies whose surfaces "top" and "bottom" meet.
struct Joint {
  std::unique_ptr<const mesh::Mesh> lower, upper;
  mesh::Surface top, bottom;
  int dimension;
  NodePoints lowerPoints, upperPoints;

  Joint(std::unique_ptr<const mesh::Mesh> below, std::unique_ptr<const mesh::Mesh> above)
      : lower(std::move(below)), upper(std::move(above)), top(lower->surface("top")),
        bottom(upper->surface("bottom")), dimension(dimensionOf(lower->cellType())),
        lowerPoints([mesh = lower.get()](GlobalOrdinal node) { return mesh->point(node); }),
        upperPoints([mesh = upper.get()](GlobalOrdinal node) { return mesh->point(node); }) {}

  [[nodiscard]] PlacedSurface first() const { return {top, lowerPoints}; }
  [[nodiscard]] PlacedSurface second() const { return {bottom, upperPoints}; }

  [[nodiscard]] ContactTerms terms() const {
    ContactTerms terms{"joint", "top"};
    terms.dimension = terms.components = dimension;
    return terms;
  }
  [[nodiscard]] ContactLayout meet() const { return meetByMortar(terms(), first(), second()); }
};

/// Bends and turns points of the joint, z (in the plane y) = 0, and what is above and below.
using Form = std::function<Point(const Point&)>;

Point asItIs(const Point& x) {
  return x;
}

/// A block on one side of the joint, of bricks or simplices of an order, formed.
std::unique_ptr<const mesh::Mesh> block(const mesh::Box& box, const std::array<int, 3>& elements,
                                        bool isSimplex, int order, const Form& form) {
  mesh::MeshArrays arrays = epafi::test::arraysOf(mesh::StructuredMesh(box, elements), {}, isSimplex);
  if (order == 2)
    arrays = mesh::completed(std::move(arrays), false);
  for (Point& point : arrays.points)
    point = form(point);
  return std::make_unique<const mesh::UnstructuredMesh>(std::move(arrays));
}

struct Sides {
  bool isPlane, isFirstSimplex, isSecondSimplex;
  int firstOrder, secondOrder;
};

constexpr Sides allSides[] = {
    {true, false, false, 1, 1},  {true, false, false, 2, 2}, {true, false, false, 2, 1},
    {false, false, false, 1, 1}, {false, true, false, 1, 1}, {false, true, true, 2, 2},
    {false, false, true, 2, 1},  {false, true, false, 2, 2}, {false, false, false, 2, 2}};

/// Blocks from `from` to 1 + `from` above, 0 to 1 below.
Joint jointOf(const Sides& sides, double from, const Form& form) {
  const auto box = [&](double start, double low, double high) {
    return sides.isPlane ? mesh::Box{{start, low, 0}, {start + 1, high, 0}}
                         : mesh::Box{{start, start / 2, low}, {start + 1, start / 2 + 1, high}};
  };
  const auto elements = [&](int n) { return sides.isPlane ? std::array{n, 2, 0} : std::array{n, n - 1, 2}; };
  return {block(box(0, -0.5, 0), elements(4), sides.isFirstSimplex, sides.firstOrder, form),
          block(box(from, 0, 0.5), elements(5), sides.isSecondSimplex, sides.secondOrder, form)};
}

/// A side of a row: Σ weight and Σ weight · x.
struct Resultant {
  double force = 0;
  Vector3d place{0, 0, 0};
};

Resultant resultantOf(const std::vector<NodeShare>& shares, const mesh::Mesh& mesh) {
  Resultant result;
  for (const NodeShare& share : shares) {
    result.force += share.weight;
    result.place += share.weight * vectorOf(mesh.point(share.node));
  }
  return result;
}

Vector3d directionOf(const ContactLayout& layout, std::size_t row, int components) {
  Vector3d direction(0, 0, 0);
  for (int c = 0; c < components; ++c)
    direction[c] =
        layout.directions[row * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)];
  return direction;
}

/// Curved and inclined: nothing about it is plane.
Point saddle(const Point& x) {
  const double z = x[2] + 0.1 * x[0] * x[0] - 0.05 * x[1] * x[1];
  return {x[0] + 0.3 * z, x[1], z};
}

Point arch(const Point& x) {
  return {x[0], x[1] + 0.1 * x[0] * x[0], 0};
}

TEST(MortarRowsTest, BothSidesOfARowBalanceInForceAndMoment) {
  for (const Sides& sides : allSides)
    for (const double shift : {0.0, 0.37}) {
      const Joint joint = jointOf(sides, shift, sides.isPlane ? arch : saddle);
      const ContactLayout layout = joint.meet();
      ASSERT_GT(layout.numRows(), 2);
      for (std::size_t row = 0; row < layout.firstNodes.size(); ++row) {
        const Resultant first = resultantOf(layout.firstShares[row], *joint.lower),
                        second = resultantOf(layout.secondNodes[row], *joint.upper);
        EXPECT_NEAR(first.force, 1, 1e-12);
        EXPECT_NEAR(second.force, 1, 1e-12);
        const Vector3d direction = directionOf(layout, row, joint.dimension);
        EXPECT_NEAR(direction.norm(), 1, 1e-14);
        EXPECT_LE((second.place - first.place).cross(direction).norm(), 1e-12) << row;
        EXPECT_NEAR(layout.gaps[row], direction.dot(second.place - first.place), 1e-13);
      }
    }
}

TEST(MortarRowsTest, AnEvenPressureHasTheRightForcesOnBothSidesAndTheWholeArea) {
  for (const Sides& sides : allSides) {
    const Joint joint = jointOf(sides, 0, asItIs);
    const ContactLayout layout = joint.meet();
    EXPECT_NEAR(std::accumulate(layout.areas.begin(), layout.areas.end(), 0.0), 1, 1e-13);
    for (const auto& [shares, points, surface] :
         {std::tuple(&layout.firstShares, &joint.lowerPoints, &joint.top),
          {&layout.secondNodes, &joint.upperPoints, &joint.bottom}}) {
      std::vector<double> forces(10000, 0.0);
      for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
        for (const NodeShare& share : (*shares)[row])
          forces[share.node] += layout.areas[row] * share.weight;
      const SurfaceNodes nodes = surfaceNodes(*points, *surface);
      for (std::size_t k = 0; k < nodes.nodes.size(); ++k)
        EXPECT_NEAR(forces[nodes.nodes[k]], nodes.areas[k], 1e-13) << k;
    }
  }
}

/// Where surfaces overlap in part, too, and whichever nodes have no multiplier.
TEST(MortarRowsTest, LinearDisplacementsOfBothSidesOpenNothing) {
  const auto field = [](const Vector3d& x) { return 0.3 + x[0] - 2 * x[1] + 0.7 * x[2]; };
  for (const Sides& sides : allSides)
    for (const double shift : {0.0, 0.23, 0.74}) {
      const Joint joint = jointOf(sides, shift, asItIs);
      const HeldNodes left = [&](GlobalOrdinal node, const Vector3d&) {
        return joint.lower->point(node)[0] < shift + 0.1;
      };
      for (const HeldNodes& isHeld : {nothingIsHeld, left}) {
        const ContactLayout layout = tieByMortar(joint.terms(), joint.first(), joint.second(), isHeld);
        double area = 0;
        for (std::size_t row = 0; row < layout.firstNodes.size(); ++row) {
          double jump = 0;
          for (const NodeShare& share : layout.firstShares[row])
            jump += share.weight * field(vectorOf(joint.lower->point(share.node)));
          for (const NodeShare& share : layout.secondNodes[row])
            jump -= share.weight * field(vectorOf(joint.upper->point(share.node)));
          EXPECT_NEAR(jump, 0, 1e-11) << row;
          area += layout.areas[row];
        }
        EXPECT_NEAR(area, joint.dimension * (1 - shift) * (sides.isPlane ? 1 : 1 - shift / 2),
                    1e-12); // no part of it is lost
      }
    }
}

TEST(MortarRowsTest, RowsAreDualWhereTheyAreWholeAndHaveNoMultiplierWhereSupportsHold) {
  const Joint joint = jointOf({false, false, false, 1, 1}, 0, asItIs);
  const ContactLayout layout = joint.meet();
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    EXPECT_EQ(layout.firstShares[row].size(), 1U); // its own node alone
  const ContactLayout held =
      tieByMortar(joint.terms(), joint.first(), joint.second(),
                  [&](GlobalOrdinal node, const Vector3d&) { return joint.lower->point(node)[0] == 0; });
  EXPECT_EQ(3 * layout.numRows() - held.numRows(), 3 * 4);
  for (const GlobalOrdinal node : held.firstNodes)
    EXPECT_GT(joint.lower->point(node)[0], 0);
  const ContactLayout tied = tieByMortar(joint.terms(), joint.first(), joint.second(), nothingIsHeld);
  EXPECT_EQ(tied.numRows(), 3 * layout.numRows());
}

/// Coordinates that 1e9 away are the same numbers: nothing may be lost.
TEST(MortarRowsTest, GapsAndSharesKeepTheirDigitsFarFromTheOrigin) {
  for (const Sides& sides : allSides) {
    const auto jointAt = [&](double x) {
      const Form form = [&, x](const Point& point) -> Point {
        const auto snapped = [](double c) { return std::round(c * 1024) / 1024; };
        const double up = sides.isPlane ? point[1] : point[2], bulge = up > 0 ? 0 : point[0] * point[0] / 16;
        if (sides.isPlane)
          return {x + snapped(point[0]), 2 * x + snapped(up - bulge), 0};
        return {x + snapped(point[0]), 2 * x + snapped(point[1]), -x + snapped(up - bulge)};
      };
      return jointOf(sides, 0.25, form);
    };
    const ContactLayout near = jointAt(0).meet(), far = jointAt(std::ldexp(1, 30)).meet();
    ASSERT_EQ(near.firstNodes, far.firstNodes);
    for (std::size_t row = 0; row < near.gaps.size(); ++row) {
      EXPECT_NEAR(near.gaps[row], far.gaps[row], 1e-12);
      ASSERT_EQ(near.secondNodes[row].size(), far.secondNodes[row].size());
      for (std::size_t k = 0; k < near.secondNodes[row].size(); ++k)
        EXPECT_NEAR(near.secondNodes[row][k].weight, far.secondNodes[row][k].weight, 1e-11);
    }
  }
}

/// A rigid motion of both bodies together: across a gap as on it.
TEST(MortarRowsTest, TiesAcrossAGapAreRigidLinks) {
  for (const Sides& sides : allSides)
    for (const double shift : {0.0, 0.37}) {
      const auto lifted = [&](const Point& x) -> Point {
        return sides.isPlane ? Point{x[0], x[1] + 0.3, 0} : Point{x[0], x[1], x[2] + 0.3};
      };
      const Joint flat = jointOf(sides, shift, asItIs);
      Joint joint = jointOf(sides, shift, asItIs);
      joint.upperPoints = [&, mesh = joint.upper.get()](GlobalOrdinal node) {
        return lifted(mesh->point(node));
      };
      ContactLayout layout = tieByMortar(joint.terms(), joint.first(), joint.second(), nothingIsHeld);
      linkRigidly(joint.first(), joint.second(), layout);
      ASSERT_EQ(layout.secondLevers.size(), layout.firstNodes.size());
      const Vector3d turn = sides.isPlane ? Vector3d(0, 0, 1) : Vector3d(0.5, -1, 0.7);
      const auto motion = [&](const Point& x) { return turn.cross(vectorOf(x)); };
      for (std::size_t row = 0; row < layout.firstNodes.size(); ++row) {
        const Vector3d direction = directionOf(layout, row, joint.dimension);
        double jump = 0;
        for (const NodeShare& share : layout.firstShares[row])
          jump += share.weight * direction.dot(motion(joint.lowerPoints(share.node)));
        for (const NodeShare& share : layout.secondNodes[row])
          jump -= share.weight * direction.dot(motion(joint.upperPoints(share.node)));
        Vector3d force(0, 0, 0);
        for (const NodeForce& lever : layout.secondLevers[row]) {
          jump -= lever.force.dot(motion(joint.upperPoints(lever.node)));
          force += lever.force;
        }
        EXPECT_NEAR(jump, 0, 1e-10) << row;
        EXPECT_NEAR(force.norm(), 0, 1e-12) << row;
      }
      ContactLayout touching = tieByMortar(flat.terms(), flat.first(), flat.second(), nothingIsHeld);
      linkRigidly(flat.first(), flat.second(), touching);
      EXPECT_TRUE(touching.secondLevers.empty());
    }
}

TEST(MortarRowsTest, SaysWhySurfacesDoNotMeet) {
  const Sides sides{true, false, false, 1, 1};
  const auto complaint = [](const Joint& joint, ContactTerms terms) {
    return test::refusal([&] { meetByMortar(terms, joint.first(), joint.second()); });
  };
  const auto moved = [&](double up) {
    return Joint(block(mesh::rectangle(0, 1, -1, 0), {4, 2, 0}, false, 1, asItIs),
                 block(mesh::rectangle(0, 1, up, up + 1), {3, 2, 0}, false, 1, asItIs));
  };
  EXPECT_NE(complaint(jointOf(sides, 2, asItIs), jointOf(sides, 2, asItIs).terms()).find("do not overlap"),
            std::string::npos);
  ContactTerms thin = moved(-0.9).terms();
  thin.thickness = [](const Vector3d&) { return 0.75; };
  EXPECT_NE(complaint(moved(-0.9), thin).find("deeper than a body is thick"), std::string::npos);
  ContactTerms near = moved(0.5).terms();
  near.distance = 0.25;
  EXPECT_NE(complaint(moved(0.5), near).find("farther apart"), std::string::npos);
  Joint away = moved(0.5);
  away.top = away.lower->surface("bottom");
  EXPECT_NE(complaint(away, away.terms()).find("face away"), std::string::npos);
}

TEST(ConvexPolygonTest, WhatTwoPolygonsShareHasTheRightArea) {
  const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Polygon diamond{{0.5, -0.5}, {1.5, 0.5}, {0.5, 1.5}, {-0.5, 0.5}}, work;
  clip(diamond, square, work);
  EXPECT_NEAR(areaOf(diamond), 1, 1e-15);
  Polygon far{{2, 0}, {3, 0}, {3, 1}};
  clip(far, square, work);
  EXPECT_LT(far.size(), 3U);
  Polygon corner{{0.5, 0.5}, {2, 0.5}, {2, 2}, {0.5, 2}};
  clip(corner, square, work);
  EXPECT_NEAR(areaOf(corner), 0.25, 1e-15);
}

TEST(ConvexPolygonTest, RulesAreExactToTheirDegree) {
  for (int degree = 0; degree <= 14; ++degree)
    for (int i = 0; i <= degree; ++i) {
      double line = 0, triangle = 0;
      for (const SimplexPoint& point : simplexRule(1, degree))
        line += point.weight * std::pow(point.xi[0], i);
      EXPECT_NEAR(line, 1.0 / (i + 1), 1e-14);
      const int j = degree - i; // ∫x^i y^j = i! j! / (i + j + 2)!, twice of it
      for (const SimplexPoint& point : simplexRule(2, degree))
        triangle += point.weight * std::pow(point.xi[0], i) * std::pow(point.xi[1], j);
      EXPECT_NEAR(triangle, 2 * std::exp(std::lgamma(i + 1) + std::lgamma(j + 1) - std::lgamma(degree + 3)),
                  1e-14);
    }
}

} // namespace
} // namespace epafi::contact
