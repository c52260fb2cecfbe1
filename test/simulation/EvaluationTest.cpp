// Stress at nodes, contact pressure and the report's results: closed forms, whatever the cells, the cut and
// the ranks.

#include "support/ElasticSample.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Slab.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/output/ContactFields.hpp"
#include "epafi/simulation/Evaluation.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <numeric>

namespace epafi::simulation {
namespace {

using fem::Physics;

struct EvaluationTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  test::TemporaryDirectory directory{comm};

  [[nodiscard]] static std::string text(const test::Kind& kind) {
    return toString(kind.physics) + ", " + mesh::toString(kind.cell) + "s";
  }
  [[nodiscard]] std::vector<double> stress(const scene::Scene& scene, const test::Field& field, int body,
                                           const RCP<const Comm>& ranks) const {
    const auto decomposition = model::decompose(scene, ranks);
    const auto solution = test::solutionWith(decomposition, field);
    return vonMisesAtNodes({scene, decomposition, solution}, body);
  }
};

TEST_F(EvaluationTest, StressOfALinearDisplacementIsExactAtEveryNode) {
  // ε_xy = γ/2 alone: √3 μ γ, beside a turn and a shift, which have no stress.
  const double shear = 0.02, turn = 0.3;
  const auto field = [&](const Point& x) {
    return std::array<double, 3>{1 + (shear - turn) * x[1], 2 + turn * x[0], 0.0};
  };
  for (const test::Kind& kind : test::kinds())
    for (const int parts : {1, 3, 7}) {
      SCOPED_TRACE(text(kind));
      const scene::Scene scene = test::stackedBlocks(kind, parts, 1, directory, *comm);
      const double mu = fem::lameConstants(kind.physics, scene.bodies[0].material).mu;
      for (const int body : {0, 1}) {
        const std::vector<double> values = stress(scene, field, body, comm);
        const GlobalOrdinal numNodes = mesh::dimensionOf(kind.cell) == 2 ? 25 : 125;
        ASSERT_EQ(static_cast<GlobalOrdinal>(values.size()), evenShare(numNodes, *comm).count);
        for (const double value : values)
          EXPECT_NEAR(value, std::sqrt(3.0) * mu * shear, 1e-11);
      }
    }
}

TEST_F(EvaluationTest, StrainAndRotationOfALinearDisplacementAreExact) {
  // ∂u₁/∂x₂ = γ − ω, ∂u₂/∂x₁ = ω: principal strains ±γ/2, and the mean turn ω − γ/2.
  const double shear = 0.02, turn = 0.3;
  for (const test::Kind& kind : test::kinds())
    for (const double size : {1.0, 0.1}) {
      SCOPED_TRACE(text(kind));
      const scene::Scene scene = test::stackedBlocks(kind, 3, 1, directory, *comm);
      const auto decomposition = model::decompose(scene, comm);
      const auto solution = test::solutionWith(decomposition, [&](const Point& x) {
        return std::array<double, 3>{1 + size * (shear - turn) * x[1], 2 + size * turn * x[0], 0.0};
      });
      const Deformation deformation = largestDeformation({scene, decomposition, solution}, 1);
      EXPECT_NEAR(deformation.strain, size * shear / 2, 1e-12);
      EXPECT_NEAR(deformation.rotation, size * (turn - shear / 2), 1e-12);
      EXPECT_EQ(deformation.isAbove(Deformation::doubtful), size == 1);
    }
}

TEST_F(EvaluationTest, ErrorsOfCellsAddUpToTheEstimateAndAreTheSameForEveryCutAndNumberOfRanks) {
  const auto field = [](const Point& x) {
    return std::array<double, 3>{x[0] * x[0] - x[1] * x[2], std::sin(x[0] + 2 * x[1]), x[2] * x[0] * x[1]};
  };
  for (const test::Kind& kind : test::kinds()) {
    SCOPED_TRACE(text(kind));
    const auto errors = [&](int parts, const RCP<const Comm>& ranks) {
      const scene::Scene scene = test::stackedBlocks(kind, parts, 1, directory, *comm);
      const auto decomposition = model::decompose(scene, ranks);
      const auto solution = test::solutionWith(decomposition, field);
      const auto estimate = accuracy::ErrorEstimator(scene, decomposition)(solution.displacement);
      double sum = 0;
      std::vector<double> upper;
      for (const int body : {0, 1}) {
        upper = cellErrors({scene, decomposition, solution}, estimate, body);
        for (const double error : upper)
          sum += error * error;
      }
      EXPECT_NEAR(std::sqrt(sumOverRanks(*ranks, sum)), estimate.discretisation,
                  1e-12 * estimate.discretisation);
      return upper;
    };
    const std::vector<double> whole = errors(1, comm->split(comm->getRank(), 0));
    for (const int parts : {2, 6}) {
      const std::vector<double> slab = errors(parts, comm);
      const RowRange range = evenShare(static_cast<GlobalOrdinal>(whole.size()), *comm);
      ASSERT_EQ(static_cast<GlobalOrdinal>(slab.size()), range.count);
      for (std::size_t k = 0; k < slab.size(); ++k)
        EXPECT_NEAR(slab[k], whole[static_cast<std::size_t>(range.first) + k], 1e-9 * (1 + slab[k]));
    }
  }
}

TEST_F(EvaluationTest, StressIsTheSameForEveryCutAndNumberOfRanks) {
  const auto field = [](const Point& x) {
    return std::array<double, 3>{x[0] * x[0] - x[1] * x[2], std::sin(x[0] + 2 * x[1]), x[2] * x[0] * x[1]};
  };
  for (const test::Kind& kind : test::kinds()) {
    SCOPED_TRACE(text(kind));
    const std::vector<double> whole =
        stress(test::stackedBlocks(kind, 1, 1, directory, *comm), field, 1, comm->split(comm->getRank(), 0));
    EXPECT_GT(*std::max_element(whole.begin(), whole.end()),
              1.1 * *std::min_element(whole.begin(), whole.end()));
    for (const int parts : {2, 6}) {
      const std::vector<double> slab =
          stress(test::stackedBlocks(kind, parts, 1, directory, *comm), field, 1, comm);
      const RowRange range = evenShare(static_cast<GlobalOrdinal>(whole.size()), *comm);
      ASSERT_EQ(static_cast<GlobalOrdinal>(slab.size()), range.count);
      for (std::size_t k = 0; k < slab.size(); ++k)
        EXPECT_NEAR(slab[k], whole[static_cast<std::size_t>(range.first) + k], 1e-10);
    }
  }
}

TEST_F(EvaluationTest, ElementsCountByTheirSize) {
  // Cells of width 1 and 3, stretched by 1 and 2 of a hundred: in between the stress is (1 · 1 + 3 · 2)/4 of
  // E/100.
  const test::Kind kind{Physics::planeStress, mesh::CellType::quadrilateral};
  scene::Scene scene;
  scene.bodies = {test::elasticBlock(kind, "strip", 0, 1, directory, *comm)};
  scene::Body& solid = scene.bodies[0];
  solid.mesh = {};
  solid.mesh.file =
      test::writeMesh(directory, *comm, "strip.msh", kind.cell, test::GridLines{{{0, 1, 4}, {0, 1}, {}}});
  solid.material.poissonsRatio = 0;
  const auto field = [](const Point& x) {
    return std::array<double, 3>{0.01 * (x[0] + std::max(0.0, x[0] - 1)), 0, 0};
  };
  const std::vector<double> values = stress(scene, field, 0, comm->split(comm->getRank(), 0));
  const std::array<double, 3> expected{2, 3.5, 4};
  ASSERT_EQ(values.size(), 6U);
  for (std::size_t node = 0; node < 6; ++node)
    EXPECT_NEAR(values[node], expected[node % 3], 1e-12);
}

TEST_F(EvaluationTest, StressKnowsTheMaterialOfRegions) {
  const test::Kind kind{Physics::elasticity3d, mesh::CellType::hexahedron};
  scene::Scene scene = test::stackedBlocks(kind, 3, 1, directory, *comm);
  fem::SolidRegion stiff;
  stiff.box.lower[0] = 0.5;
  stiff.material = scene.bodies[0].material;
  stiff.material.youngsModulus *= 3;
  scene.bodies[0].regions.push_back(stiff);
  const auto field = [](const Point& x) { return std::array<double, 3>{0, 0.01 * x[2], 0}; };
  const double soft = std::sqrt(3.0) * 200 / 2.6 * 0.01;
  const std::vector<double> values = stress(scene, field, 0, comm);
  const GlobalOrdinal first = evenShare(125, *comm).first;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const GlobalOrdinal column = (first + static_cast<GlobalOrdinal>(k)) % 5;
    EXPECT_NEAR(values[k], soft * (column < 2 ? 1 : column == 2 ? 2 : 3), 1e-12);
  }
}

TEST_F(EvaluationTest, MembranesHaveNoStress) {
  scene::Scene scene;
  scene.bodies.resize(1);
  scene.bodies[0].name = "membrane";
  scene.bodies[0].mesh.box = mesh::rectangle(0, 1, 0, 1);
  scene.bodies[0].mesh.elements = {8, 8, 0};
  scene.bodies[0].supports = {{"wall", "left", {0.0}}};
  const auto decomposition = model::decompose(scene, comm);
  const auto solution = test::solutionWith(decomposition, [](const Point& x) {
    return std::array{x[0], 0.0, 0.0};
  });
  const Evaluation evaluation = evaluate({scene, decomposition, solution});
  ASSERT_EQ(evaluation.vonMises.size(), 1U);
  EXPECT_TRUE(evaluation.vonMises[0].empty());
  EXPECT_TRUE(contactResults({scene, decomposition, solution}, evaluation).empty());
  EXPECT_FALSE(bodyResults({scene, decomposition, solution}, evaluation).at(0).isElastic);
}

TEST_F(EvaluationTest, PatchTestHasTheLoadAsPressureAndItsStressInTheResults) {
  const double pressure = 3;
  for (const test::Kind& kind : test::kinds()) {
    SCOPED_TRACE(text(kind));
    const bool isPlane = mesh::dimensionOf(kind.cell) == 2;
    const scene::Scene scene = test::stackedBlocks(kind, 3, pressure, directory, *comm);
    const auto decomposition = model::decompose(scene, comm);
    Teuchos::ParameterList parameters;
    parameters.set("Tolerance", 1e-12).set("Equilibrium Tolerance", 1e-12);
    ContactSolver solver(parameters);
    solver.setup(decomposition.problem, decomposition.data);
    const fetidp::ContactSolution solution = solver.solve(decomposition.data);
    const SolvedScene solved{scene, decomposition, solution};
    const Evaluation evaluation = evaluate(solved);

    const double area = isPlane ? 0.5 : 1; // the thickness is 0.5
    const output::ContactFields fields = output::gatherContactFields(solved, 0, evaluation.contacts[0]);
    for (const double value : fields.pressure)
      EXPECT_NEAR(value, pressure, 1e-8);
    for (std::size_t k = 0; k < fields.normals.size(); ++k)
      EXPECT_NEAR(fields.normals[k], k % 3 == (isPlane ? 1 : 2) ? 1 : 0, 1e-14);
    EXPECT_EQ(fields.nodesPerFacet(), mesh::nodesPerFacet(kind.cell));
    EXPECT_EQ(fields.numFacets, isPlane ? 4 : kind.cell == mesh::CellType::tetrahedron ? 32 : 16);

    const ContactResult joint = contactResults(solved, evaluation).at(0);
    EXPECT_EQ(joint.name, "joint");
    EXPECT_EQ(joint.candidates, isPlane ? 5 : 25);
    EXPECT_EQ(joint.activeNodes, isPlane ? 5 : 25);
    EXPECT_NEAR(joint.force, pressure * area, 1e-9);
    EXPECT_NEAR(joint.area, area, 1e-12);
    EXPECT_NEAR(joint.largestPressure, pressure, 1e-8);
    for (std::size_t d = 0; d < 3; ++d)
      EXPECT_NEAR(joint.resultant[d], d == (isPlane ? 1 : 2) ? -pressure * area : 0, 1e-9);

    // Stress −p along the stack, in plane strain −νp across the plane; the upper block sinks by both strains.
    const double nu = 0.3, along = kind.physics == Physics::planeStrain ? 1 - nu * nu : 1,
                 across = kind.physics == Physics::planeStrain ? nu * (1 + nu) : nu;
    const BodyResult upper = bodyResults(solved, evaluation).at(1);
    EXPECT_EQ(upper.name, "upper");
    EXPECT_NEAR(upper.largestStress,
                kind.physics == Physics::planeStrain ? pressure * std::sqrt(1 - nu + nu * nu) : pressure,
                1e-7);
    EXPECT_NEAR(upper.largestDisplacement,
                pressure / 200 * std::sqrt(4 * along * along + (isPlane ? 1 : 2) * across * across), 1e-9);
  }
}

TEST_F(EvaluationTest, ResultsCountActiveRowsAndSumAllForces) {
  const test::Kind kind{Physics::planeStrain, mesh::CellType::quadrilateral};
  scene::Scene scene = test::stackedBlocks(kind, 2, 1, directory, *comm);
  fem::SolidRegion thick; // the right half of both blocks
  thick.box.lower[0] = 0.5;
  thick.material = scene.bodies[0].material;
  thick.material.thickness = 2;
  for (scene::Body& body : scene.bodies)
    body.regions.push_back(thick);
  const auto decomposition = model::decompose(scene, comm);
  const auto solution = test::solutionWith(decomposition, [](const Point&) {
    return std::array{3.0, 4.0, 0.0};
  });
  for (GlobalOrdinal row = 0; row < 5; ++row)
    if (decomposition.problem.multiplierMap->isNodeGlobalElement(row)) {
      solution.multiplier->replaceGlobalValue(row, static_cast<double>(row));
      solution.active->replaceGlobalValue(row, row > 2 ? 1.0 : 0.0);
    }
  const SolvedScene solved{scene, decomposition, solution};
  const Evaluation evaluation = evaluate(solved);
  // Quarters of the length: 0.5 thick left of the middle, 2 thick right of it.
  EXPECT_EQ(evaluation.contacts[0].areas.size(), 5U);
  const std::vector<double> areas{0.0625, 0.125, 0.3125, 0.5, 0.25};
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_NEAR(evaluation.contacts[0].areas[k], areas[k], 1e-14);

  const ContactResult joint = contactResults(solved, evaluation).at(0);
  EXPECT_EQ(joint.candidates, 5);
  EXPECT_EQ(joint.activeNodes, 2);
  EXPECT_DOUBLE_EQ(joint.force, 10);
  EXPECT_DOUBLE_EQ(joint.largestPressure, 16);
  EXPECT_NEAR(joint.area, 0.75, 1e-14);
  const BodyResult lower = bodyResults(solved, evaluation).at(0);
  EXPECT_DOUBLE_EQ(lower.largestDisplacement, 5);
  EXPECT_NEAR(lower.largestStress, 0, 1e-11);
}

} // namespace
} // namespace epafi::simulation
