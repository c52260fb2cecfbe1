// The estimate of the discretisation error: nothing where the flux is right already, also beside other
// materials; what it should be where the solution is smooth; the same for every cut and number of ranks.

#include "epafi/accuracy/ErrorEstimate.hpp"

#include "Samples.hpp"

#include "epafi/accuracy/ErrorNorms.hpp"

#include <Teuchos_Comm.hpp>

namespace epafi::accuracy {
namespace {

using test::Field;
using ErrorEstimateTest = test::AccuracyTest;

TEST_F(ErrorEstimateTest, AStateOfConstantStressHasNoError) {
  const Field field = [](const Point& x) {
    return std::array<double, 3>{0.1 * x[0] - 0.2 * x[1], 0.3 * x[0] + 0.4 * x[1] - 0.1 * x[2], 0.2 * x[2]};
  };
  for (const test::Kind& kind : test::kinds())
    for (const int parts : {1, 5}) {
      const scene::Scene scene = test::stackedBlocks(kind, parts, 1, directory, *comm);
      const auto decomposition = model::decompose(scene, comm);
      const ErrorEstimate estimate = ErrorEstimator(scene, decomposition)(displacement(decomposition, field));
      EXPECT_GT(estimate.energyNorm, 1);
      EXPECT_LE(estimate.discretisation, 1e-12 * estimate.energyNorm) << toString(kind.physics);
    }
}

TEST_F(ErrorEstimateTest, AFluxThatJumpsWithTheMaterialHasNoError) {
  // κ = 1 left of x = 1 and 100 right of it; the flux along x is the same, that along y jumps.
  scene::Scene scene = test::membrane(6, 3);
  scene.bodies[0].regions.push_back({"right", mesh::rectangle(1, 2, 0, 1), "", {100}});
  const Field field = [](const Point& x) {
    return std::array<double, 3>{(x[0] < 1 ? x[0] : 1 + (x[0] - 1) / 100) + x[1], 0, 0};
  };
  const auto decomposition = model::decompose(scene, comm);
  const ErrorEstimate estimate = ErrorEstimator(scene, decomposition)(displacement(decomposition, field));
  EXPECT_NEAR(estimate.energyNorm, std::sqrt(1 + 0.01 + 1 + 100), 1e-12);
  EXPECT_LE(estimate.discretisation, 1e-12 * estimate.energyNorm);
}

/// −u″ = sin: interpolated at the nodes, linear elements have their error to leading order in h.
TEST_F(ErrorEstimateTest, IsAsymptoticallyExactForASmoothField) {
  const auto value = [](const Point& x) { return std::sin(x[0]) * std::cos(2 * x[1]); };
  const ExactField exact = [&](int /*body*/, const Point& x) {
    fem::FieldValue field;
    field.displacement = {value(x)};
    field.flux = {std::cos(x[0]) * std::cos(2 * x[1]), -2 * std::sin(x[0]) * std::sin(2 * x[1])};
    return field;
  };
  double distance = 1; // of the effectivity from 1
  for (const int elements : {8, 16, 32}) {
    const scene::Scene scene = test::membrane(elements, 4);
    const auto decomposition = model::decompose(scene, comm);
    const auto u = displacement(decomposition, [&](const Point& x) {
      return std::array<double, 3>{value(x), 0, 0};
    });
    const double error = errorNorms(scene, decomposition, u, exact).energy;
    const double effectivity = ErrorEstimator(scene, decomposition)(u).discretisation / error;
    EXPECT_LT(std::abs(effectivity - 1), 0.6 * distance);
    distance = std::abs(effectivity - 1);
  }
  EXPECT_LT(distance, 0.05);
}

TEST_F(ErrorEstimateTest, IsTheSameForEveryCutAndNumberOfRanks) {
  const Field field = [](const Point& x) {
    return std::array<double, 3>{x[0] * x[0] - x[1] * x[2], std::sin(x[0] + 2 * x[1]), x[2] * x[0] * x[1]};
  };
  for (const test::Kind& kind : test::kinds()) {
    const auto estimate = [&](int parts, const RCP<const Comm>& ranks) {
      scene::Scene scene = test::stackedBlocks(kind, parts, 1, directory, *comm);
      fem::SolidRegion core{"core", {{-1, -1, -1}, {0.5, 0.5, 0.5}}, "", scene.bodies[0].material};
      core.material.youngsModulus *= 10;
      scene.bodies[0].regions.push_back(core);
      const auto decomposition = model::decompose(scene, ranks);
      return ErrorEstimator(scene, decomposition)(displacement(decomposition, field));
    };
    const ErrorEstimate whole = estimate(1, comm->split(comm->getRank(), 0));
    EXPECT_GT(whole.relative(), 0.02);
    for (const int parts : {2, 6}) {
      const ErrorEstimate cut = estimate(parts, comm);
      EXPECT_NEAR(cut.discretisation, whole.discretisation, 1e-11 * whole.discretisation);
      EXPECT_NEAR(cut.energyNorm, whole.energyNorm, 1e-11 * whole.energyNorm);
    }
  }
}

} // namespace
} // namespace epafi::accuracy
