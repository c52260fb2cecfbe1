// Means of displacements, and errors by polarisation.

#include "epafi/accuracy/Quantity.hpp"

#include "Samples.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Errors.hpp"

#include <cmath>

namespace epafi::accuracy {
namespace {

using QuantityTest = test::AccuracyTest;

double product(const std::vector<Eigen::VectorXd>& weights, const std::vector<Eigen::VectorXd>& u,
               const Comm& comm) {
  AccurateSum sum;
  for (std::size_t s = 0; s < u.size(); ++s)
    sum.add(weights[s].dot(u[s]));
  sumOverRanks(comm, {&sum, 1});
  return sum.value();
}

double linear(const Point& x) {
  return 3 + 2 * x[0] - x[1];
}

TEST_F(QuantityTest, WeightsGiveValuesAndMeansOfLinearFields) {
  const scene::Scene scene = test::membrane(6, 3);
  const auto decomposition = model::decompose(scene, comm);
  const auto u = displacement(decomposition, [](const Point& x) {
    return std::array<double, 3>{linear(x), 0, 0};
  });
  for (const Point& point : {Point{0.31, 0.77, 0}, {1, 0.5, 0}, {2, 1, 0}, {2.0 / 3, 1.0 / 3, 0}})
    EXPECT_NEAR(product(displacementWeights(decomposition, {0, "", point}), u, *comm), linear(point), 1e-12);
  EXPECT_NEAR(product(displacementWeights(decomposition, {0, "right", {}}), u, *comm), linear({2, 0.5, 0}),
              1e-12);
  EXPECT_NEAR(product(displacementWeights(decomposition, {0, "top", {}}), u, *comm), linear({1, 1, 0}),
              1e-12);
}

TEST_F(QuantityTest, WeightsOfElasticBodiesMeasureAlongADirectionOfAnyLength) {
  const test::Field turned = [](const Point& x) {
    return std::array<double, 3>{0.5 - 0.1 * x[1], 0.2 + 0.1 * x[0], 0};
  };
  for (const test::Kind& kind : test::kinds()) {
    const scene::Scene scene = test::stackedBlocks(kind, 3, 1, directory, *comm);
    const auto decomposition = model::decompose(scene, comm);
    const auto u = displacement(decomposition, turned);
    const Point point{0.3, 0.2, 0};
    const double x = product(displacementWeights(decomposition, {0, "", point, {7, 0, 0}}), u, *comm),
                 y = product(displacementWeights(decomposition, {0, "", point, {0, 0.01, 0}}), u, *comm),
                 both = product(displacementWeights(decomposition, {0, "", point, {1, 1, 0}}), u, *comm);
    EXPECT_NEAR(x, turned(point)[0], 1e-12) << toString(kind.physics);
    EXPECT_NEAR(y, turned(point)[1], 1e-12);
    EXPECT_NEAR(both, (x + y) / std::sqrt(2.0), 1e-12);
  }
}

TEST_F(QuantityTest, WhatIsNotThereIsRefused) {
  const auto decomposition = model::decompose(test::membrane(4, 2), comm);
  EXPECT_THROW(displacementWeights(decomposition, {0, "lid", {}}), InputError);
  EXPECT_THROW(displacementWeights(decomposition, {0, "", {5, 5, 0}}), InputError);
}

/// e_T is symmetric, and η_T² for z = u; of order 2 with what elements do not resolve.
TEST_F(QuantityTest, ErrorsAreThoseOfTheEnergyWhereTheDualSolutionIsTheSolution) {
  for (const int order : {1, 2}) {
    scene::Scene scene = test::membrane(6, 3);
    for (scene::Body& body : scene.bodies)
      body.mesh.order = order;
    const auto decomposition = model::decompose(scene, comm);
    const auto u = displacement(decomposition, [](const Point& x) {
      return std::array<double, 3>{std::sin(2 * x[0]) * std::cos(x[1]), 0, 0};
    });
    const auto v = displacement(decomposition, [](const Point& x) {
      return std::array<double, 3>{std::cos(3 * x[0] * x[1]), 0, 0};
    });
    ErrorEstimator estimator(scene, decomposition);
    EXPECT_EQ(estimator.correctsElements(), order == 2);
    const ErrorEstimate estimate = estimator(u);
    const auto times = [](double factor, std::vector<Eigen::VectorXd> w) {
      for (Eigen::VectorXd& values : w)
        values *= factor;
      return w;
    };
    const QuantityError own = quantityError(*comm, estimator, estimate, u, times(-3, u));
    const double squared = estimate.discretisation * estimate.discretisation;
    EXPECT_NEAR(own.error, -3 * squared, 1e-10 * squared);
    EXPECT_NEAR(own.bar, 3 * squared, 1e-10 * squared);
    EXPECT_NEAR(own.dualNorm, 3 * estimate.energyNorm, 1e-12 * estimate.energyNorm);
    for (std::size_t s = 0; s < own.elements.size(); ++s)
      for (std::size_t e = 0; e < own.elements[s].size(); ++e)
        EXPECT_NEAR(own.elements[s][e], 3 * estimate.elements[s][e], 1e-10 * squared);

    const QuantityError uv = quantityError(*comm, estimator, estimate, u, v),
                        vu = quantityError(*comm, estimator, estimator(v), v, u);
    EXPECT_NEAR(uv.error, vu.error, 1e-10 * uv.bar);
    EXPECT_NEAR(uv.bar, vu.bar, 1e-10 * uv.bar);
    EXPECT_GT(uv.bar, std::abs(uv.error));
  }
}

} // namespace
} // namespace epafi::accuracy
