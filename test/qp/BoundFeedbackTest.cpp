// The factor by which errors of bounds that follow the solution shrink, beside the largest eigenvalue of a
// dense derivative.

#include "support/Problems.hpp"

#include "epafi/base/Maps.hpp"
#include "epafi/qp/constraints/Discs.hpp"
#include "epafi/qp/solve/BoundFeedback.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace epafi;

/// Nodes that are open, stick or slip in turns: of each a normal entry x_n ≥ 0 and one or two tangential
/// ones, at most μ x_n. The gradient is what holds what slips there.
struct Nodes {
  int numNodes, components;
  double friction;
  Eigen::MatrixXd a;
  Eigen::VectorXd x, gradient;
  Eigen::MatrixXd rows = Eigen::MatrixXd(0, 0); ///< orthonormal, or none

  Nodes(int number, int dimension, double coefficient, unsigned seed)
      : numNodes(number), components(dimension), friction(coefficient),
        a(number * dimension, number * dimension), x(Eigen::VectorXd::Zero(a.rows())), gradient(x) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto nodeOf = [dimension](Eigen::Index row) { return row / dimension; };
    Eigen::MatrixXd mixing(a.rows(), a.rows());
    for (Eigen::Index i = 0; i < a.rows(); ++i)
      for (Eigen::Index j = 0; j < a.rows(); ++j)
        mixing(i, j) = normal(random) * std::exp(-static_cast<double>(std::abs(nodeOf(i) - nodeOf(j))));
    a = mixing * mixing.transpose() + Eigen::MatrixXd::Identity(a.rows(), a.rows());
    for (int k = 0; k < numNodes; ++k) {
      const Eigen::Index first = Eigen::Index{dimension} * k;
      if (isOpen(k))
        continue;
      x[first] = 1 + 0.1 * k;
      Eigen::VectorXd along(dimension - 1);
      for (double& entry : along)
        entry = normal(random);
      along.normalize();
      x.segment(first + 1, dimension - 1) = (slips(k) ? 1.0 : 0.5) * friction * x[first] * along;
      if (slips(k))
        gradient.segment(first + 1, dimension - 1) = -(0.1 + 0.05 * k) * along;
    }
  }
  [[nodiscard]] static bool isOpen(int node) { return node % 5 == 4; }
  [[nodiscard]] static bool slips(int node) { return node % 5 == 0 || node % 5 == 2; }

  [[nodiscard]] qp::QuadraticProgram handedOver(bool isPreconditioned) const {
    const auto nodes = test::linearMap(numNodes);
    std::vector<GlobalOrdinal> mine;
    for (std::size_t i = 0; i < numLocal(*nodes); ++i)
      for (int k = 0; k < components; ++k)
        mine.push_back(components * nodes->getGlobalElement(static_cast<LocalOrdinal>(i)) + k);
    const auto map = makeMap(std::move(mine), nodes->getComm());
    qp::QuadraticProgram program;
    program.hessian = rcp(new test::DenseOperator(map, a));
    if (isPreconditioned)
      program.preconditioner = rcp(new test::DenseOperator(map, 4 * a.inverse().eval()));
    if (rows.rows() > 0)
      program.equality = rcp(new test::DenseEquality(map, rows));
    program.setAt = [=, this](const Vector& at) { return setAt(at); };
    return program;
  }
  [[nodiscard]] RCP<const qp::ConvexSet> setAt(const Vector& at) const {
    const auto values = at.getData();
    const RCP<Vector> lower = rcp(new Vector(at.getMap())), upper = rcp(new Vector(at.getMap()));
    upper->putScalar(test::unbounded);
    std::vector<qp::Disc> discs;
    std::vector<qp::Box::Growth> growth;
    for (LocalOrdinal n = 0; n < static_cast<LocalOrdinal>(values.size()); n += components) {
      const double bound = friction * values[n];
      if (components == 3) {
        discs.push_back({n + 1, n + 2, bound, {}, n, friction});
        continue;
      }
      growth.push_back({n + 1, n, friction});
      lower->replaceLocalValue(n + 1, -bound);
      upper->replaceLocalValue(n + 1, bound);
    }
    if (components == 3)
      return rcp(new qp::Discs(qp::Box(lower), discs, at.getMap()));
    return rcp(new qp::Box(lower, upper, growth));
  }

  [[nodiscard]] double largestEigenvalue() const { return derivative().eigenvalues().cwiseAbs().maxCoeff(); }
  /// T′ = S − Z(Zᵀ(A + K)Z)⁻¹ZᵀAS, with Bv = 0 where there are rows.
  [[nodiscard]] Eigen::MatrixXd derivative() const {
    const Eigen::Index n = a.rows(), m = rows.rows();
    Eigen::MatrixXd follows = Eigen::MatrixXd::Zero(n, n), face = Eigen::MatrixXd::Zero(n, n), bending = face;
    for (int k = 0; k < numNodes; ++k) {
      const Eigen::Index first = Eigen::Index{components} * k, tangents = components - 1;
      if (isOpen(k))
        continue;
      face(first, first) = 1;
      auto block = face.block(first + 1, first + 1, tangents, tangents);
      block.setIdentity();
      if (!slips(k))
        continue;
      const Eigen::VectorXd pair = x.segment(first + 1, tangents), along = pair.normalized();
      block -= along * along.transpose();
      bending.block(first + 1, first + 1, tangents, tangents) =
          gradient.segment(first + 1, tangents).norm() / pair.norm() * block;
      follows.block(first + 1, first, tangents, 1) = friction * along;
    }
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + m, n + m), right = Eigen::MatrixXd::Zero(n + m, n);
    const Eigen::MatrixXd off = Eigen::MatrixXd::Identity(n, n) - face;
    whole.topLeftCorner(n, n) = face * (a + bending) * face + off;
    right.topRows(n) = -face * a * follows;
    if (m > 0) {
      whole.topRightCorner(n, m) = face * rows.transpose();
      whole.bottomLeftCorner(m, n) = rows * face;
      right.bottomRows(m) = -rows * follows;
    }
    return follows + whole.fullPivLu().solve(right).topRows(n);
  }
};

qp::BoundFeedback feedbackOf(const Nodes& nodes, bool isPreconditioned) {
  const qp::QuadraticProgram program = nodes.handedOver(isPreconditioned);
  const auto map = program.hessian->getDomainMap();
  return boundFeedback(program, *test::makeVector(map, nodes.x), *test::makeVector(map, nodes.gradient),
                       *test::makeVector(map, nodes.x));
}

TEST(BoundFeedbackTest, OfOneNodeThatSlipsItIsWhatItsTangentialForceMakesOfItsNormalOne) {
  // Ax = b in x_n = −(c/a) x_t: bounds that are off by d make x_n off by μ c/a d
  Nodes node(1, 2, 0.6, 1);
  node.a << 2, 1, 1, 3;
  const qp::BoundFeedback found = feedbackOf(node, false);
  EXPECT_NEAR(node.largestEigenvalue(), 0.3, 1e-15);
  EXPECT_NEAR(found.factor, 0.3, 1e-8);
  EXPECT_LE(found.multiplications, 12);
}

TEST(BoundFeedbackTest, WhatAnErrorBecomesIsTheSumOfAllItsImages) {
  for (const int components : {2, 3})
    for (const double friction : {0.3, 1.0})
      for (unsigned seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE(testing::Message()
                     << components << " components, friction " << friction << ", seed " << seed);
        const Nodes nodes(12, components, friction, seed);
        Eigen::VectorXd error = nodes.x; // what of x the face may move: not what slips, along its force
        for (int k = 0; k < nodes.numNodes; ++k)
          if (Nodes::slips(k))
            error.segment(Eigen::Index{components} * k + 1, components - 1).setZero();
        const Eigen::Index n = error.size();
        const Eigen::VectorXd whole =
            (Eigen::MatrixXd::Identity(n, n) - nodes.derivative()).fullPivLu().solve(error);
        const double expected = std::sqrt(whole.dot(nodes.a * whole) / error.dot(nodes.a * error));
        EXPECT_NEAR(feedbackOf(nodes, true).amplification, expected, 0.15 * expected);
      }
}

TEST(BoundFeedbackTest, WhereNothingSlipsThereIsNone) {
  Nodes nodes(2, 3, 0.5, 3);
  nodes.x.segment(1, 2) *= 0.5;
  EXPECT_EQ(feedbackOf(nodes, true).factor, 0);
  EXPECT_EQ(feedbackOf(nodes, true).multiplications, 0);
}

TEST(BoundFeedbackTest, WithoutADirectionOrTimeItIsNotKnown) {
  const Nodes nodes(4, 3, 0.5, 3);
  const qp::QuadraticProgram program = nodes.handedOver(true);
  const auto map = program.hessian->getDomainMap();
  const auto x = test::makeVector(map, nodes.x), gradient = test::makeVector(map, nodes.gradient);
  EXPECT_TRUE(std::isnan(boundFeedback(program, *x, *gradient, Vector(map)).factor));
  const qp::BoundFeedback stopped = boundFeedback(program, *x, *gradient, *x, [] { return true; });
  EXPECT_TRUE(std::isnan(stopped.factor));
  EXPECT_LE(stopped.multiplications, 1);
}

TEST(BoundFeedbackTest, ItIsTheLargestEigenvalueOfTheDerivative) {
  for (const int components : {2, 3})
    for (const double friction : {0.1, 0.3, 1.0})
      for (const bool isPreconditioned : {false, true})
        for (const int numRows : {0, 1})
          for (unsigned seed = 1; seed <= 5; ++seed) {
            Nodes nodes(12, components, friction, seed);
            if (numRows > 0) { // the sum of all forces along one tangent
              nodes.rows = Eigen::MatrixXd::Zero(1, nodes.a.rows());
              for (int k = 0; k < nodes.numNodes; ++k)
                nodes.rows(0, components * k + 1) = 1 / std::sqrt(static_cast<double>(nodes.numNodes));
            }
            const double expected = nodes.largestEigenvalue();
            const qp::BoundFeedback found = feedbackOf(nodes, isPreconditioned);
            SCOPED_TRACE(testing::Message()
                         << components << " components, friction " << friction << ", rows " << numRows
                         << ", preconditioned " << isPreconditioned << ", seed " << seed << ": " << expected
                         << " " << found.factor << " by " << found.multiplications);
            EXPECT_LE(std::abs(found.factor - expected), (isPreconditioned ? 0.15 : 0.35) * (1 - expected));
            EXPECT_LE(found.multiplications, isPreconditioned ? 40 : 70);
          }
}

} // namespace
