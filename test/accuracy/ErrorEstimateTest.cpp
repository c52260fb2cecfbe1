// The estimate of the discretisation error: nothing where the flux is right already, also beside other
// materials; what it should be where the solution is smooth; the same for every cut and number of ranks. What
// patches recover of order 2.

#include "epafi/accuracy/ErrorEstimate.hpp"

#include "Samples.hpp"

#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/accuracy/RecoveredFlux.hpp"

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

TEST_F(ErrorEstimateTest, AStateOfLinearStressHasNoErrorOfOrderTwo) {
  const Field field = [](const Point& x) {
    return std::array<double, 3>{x[0] * x[0] - 0.5 * x[1] * x[2], 0.3 * x[0] * x[1] + x[1] * x[1],
                                 x[2] * x[0] - 0.2 * x[2] * x[2]};
  };
  for (const test::Kind& kind : test::kinds())
    for (const int parts : {1, 5}) {
      scene::Scene scene = test::stackedBlocks(kind, parts, 1, directory, *comm);
      for (scene::Body& body : scene.bodies)
        body.mesh.order = 2;
      const auto decomposition = model::decompose(scene, comm);
      const ErrorEstimate estimate = ErrorEstimator(scene, decomposition)(displacement(decomposition, field));
      EXPECT_GT(estimate.energyNorm, 1);
      EXPECT_LE(estimate.discretisation, 1e-10 * estimate.energyNorm) << toString(kind.physics);
    }
}

/// Quadrilaterals have the flux of a cubic field at their 2 × 2 points exactly.
TEST_F(ErrorEstimateTest, PatchesRecoverAQuadraticFluxOfOrderTwo) {
  scene::Scene scene = test::membrane(6, 3);
  scene.bodies[0].mesh.order = 2;
  const auto decomposition = model::decompose(scene, comm);
  const auto u = displacement(decomposition, [](const Point& x) {
    return std::array<double, 3>{std::pow(x[0], 3) - 2 * x[0] * x[0] * x[1] + std::pow(x[1], 3), 0, 0};
  });
  std::vector<BodyElements> bodies = elementsOfBodies(scene, decomposition);
  const std::vector<SubdomainFlux> fluxes = recoverFlux(bodies, decomposition, u);
  for (std::size_t s = 0; s < fluxes.size(); ++s)
    for (Eigen::Index slot = 0; slot < fluxes[s].values.cols(); ++slot) {
      const Point x = decomposition.bodies[0].mesh->point(
          decomposition.problem.subdomains[s].nodes[fluxes[s].nodeOf(static_cast<std::size_t>(slot))]);
      constexpr double size = 1.0 / 6, roundOff = 1e-9; // patches at the border lack points
      if (std::min({x[0], 2 - x[0], x[1], 1 - x[1]}) < size - roundOff)
        continue;
      EXPECT_NEAR(fluxes[s].values(0, slot), 3 * x[0] * x[0] - 4 * x[0] * x[1], roundOff);
      EXPECT_NEAR(fluxes[s].values(1, slot), -2 * x[0] * x[0] + 3 * x[1] * x[1], roundOff);
    }
}

/// Where a body force ends the flux has a kink, which elements that end there have, too.
TEST_F(ErrorEstimateTest, AKinkWhereABodyForceEndsIsNoError) {
  scene::Scene scene = test::membrane(6, 3);
  scene.bodies[0].mesh.order = 2;
  scene.bodies[0].loads.push_back(fem::loadInside("half", mesh::rectangle(1, 2, 0, 1), -2));
  const auto decomposition = model::decompose(scene, comm);
  const auto u = displacement(decomposition, [](const Point& x) {
    return std::array<double, 3>{x[0] < 1 ? 0 : std::pow(x[0] - 1, 2), 0, 0};
  });
  const ErrorEstimate estimate = ErrorEstimator(scene, decomposition)(u);
  EXPECT_LE(estimate.discretisation, 1e-10 * estimate.energyNorm);
}

/// −u″ = sin: interpolated at the nodes, elements have their error to leading order in h.
TEST_F(ErrorEstimateTest, IsAsymptoticallyExactForASmoothField) {
  const auto value = [](const Point& x) { return std::sin(x[0]) * std::cos(2 * x[1]); };
  const ExactField exact = [&](int /*body*/, const Point& x) {
    fem::FieldValue field;
    field.displacement = {value(x)};
    field.flux = {std::cos(x[0]) * std::cos(2 * x[1]), -2 * std::sin(x[0]) * std::sin(2 * x[1])};
    return field;
  };
  for (const int order : {1, 2}) {
    double distance = 1; // of the effectivity from 1
    for (const int elements : {8, 16, 32}) {
      scene::Scene scene = test::membrane(elements, 4);
      scene.bodies[0].mesh.order = order;
      const auto decomposition = model::decompose(scene, comm);
      const auto u = displacement(decomposition, [&](const Point& x) {
        return std::array<double, 3>{value(x), 0, 0};
      });
      const double error = errorNorms(scene, decomposition, u, exact).energy;
      const double effectivity = ErrorEstimator(scene, decomposition)(u).discretisation / error;
      EXPECT_LT(std::abs(effectivity - 1), order == 1 ? 0.6 * distance : 0.06);
      distance = std::abs(effectivity - 1);
    }
    EXPECT_LT(distance, 0.05);
  }
}

TEST_F(ErrorEstimateTest, IsTheSameForEveryCutAndNumberOfRanks) {
  const Field field = [](const Point& x) {
    return std::array<double, 3>{x[0] * x[0] - x[1] * x[2], std::sin(x[0] + 2 * x[1]), x[2] * x[0] * x[1]};
  };
  for (const test::Kind& kind : test::kinds()) {
    const auto estimate = [&](int order, int parts, const RCP<const Comm>& ranks) {
      scene::Scene scene = test::stackedBlocks(kind, parts, 1, directory, *comm);
      for (scene::Body& body : scene.bodies)
        body.mesh.order = order;
      const fem::SolidLoad weight{
          "weight", fem::SolidLoad::Kind::body, {{-1, -1, -1}, {2, 0.5, 2}}, "", {0, 0, 0}, {1, 0, 0}};
      scene.bodies[0].loads.push_back(weight);
      fem::SolidRegion core{"core", {{-1, -1, -1}, {0.5, 0.5, 0.5}}, "", scene.bodies[0].material};
      core.material.youngsModulus *= 10;
      scene.bodies[0].regions.push_back(core);
      const auto decomposition = model::decompose(scene, ranks);
      return ErrorEstimator(scene, decomposition)(displacement(decomposition, field));
    };
    for (const int order : {1, 2}) {
      const ErrorEstimate whole = estimate(order, 1, comm->split(comm->getRank(), 0));
      EXPECT_GT(whole.relative(), order == 1 ? 0.02 : 0.001);
      for (const int parts : {2, 6}) {
        const ErrorEstimate cut = estimate(order, parts, comm);
        EXPECT_NEAR(cut.discretisation, whole.discretisation, 1e-10 * whole.discretisation);
        EXPECT_NEAR(cut.energyNorm, whole.energyNorm, 1e-11 * whole.energyNorm);
      }
    }
  }
}

} // namespace
} // namespace epafi::accuracy
