// Guaranteed bounds beside solutions on meshes four times finer: energies and errors lie within them, and
// they are not much larger; the same on every number of ranks; what is not covered is refused.

#include "support/ElasticSample.hpp"
#include "support/SampleCells.hpp"
#include "support/SolidScenes.hpp"

#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/accuracy/Refinement.hpp"
#include "epafi/scene/ModelProblem.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace epafi::simulation {
namespace {

using fem::Physics;
using fem::SolidLoad;
using mesh::CellType;
using scene::Scene;

struct GuaranteedBoundTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  test::TemporaryDirectory directory{comm};

  SceneRun solve(const Scene& scene, double asked = 1e-10, const RCP<const Comm>& ranks = {}) const {
    return solveScene(scene, Teuchos::ParameterList().set("Tolerance", asked), ranks.is_null() ? comm : ranks,
                      {.estimatesError = true, .bound = true});
  }

  static bool isPlane(const test::Kind& kind) { return mesh::dimensionOf(kind.cell) == 2; }
  /// Along the last axis.
  static Vector3 upwards(const test::Kind& kind, double value) {
    return isPlane(kind) ? Vector3{0, value, 0} : Vector3{0, 0, value};
  }

  /// A block of 4 × 4 cells, in space of 2 × 2 × 2, in four subdomains, 2 long and from a height on 1 high.
  /// Collective.
  scene::Body block(const test::Kind& kind, int order, const std::string& name, double bottom) const {
    const int cells = isPlane(kind) ? 4 : 2;
    scene::Body body;
    body.name = name;
    body.physics = kind.physics;
    body.material = {2.0, 200.0, 0.3, 0.5};
    body.mesh.order = order;
    body.decomposition = test::cutByMetis(4);
    if (kind.cell == CellType::triangle || kind.cell == CellType::tetrahedron) {
      const auto along = test::evenLines(0, 2, cells), across = test::evenLines(0, 1, cells),
                 up = test::evenLines(bottom, bottom + 1, cells);
      body.mesh.file = test::writeMesh(directory, *comm, name + ".msh", kind.cell,
                                       isPlane(kind) ? test::GridLines{along, up, {}}
                                                     : test::GridLines{along, across, up});
    } else {
      body.mesh.box = isPlane(kind) ? mesh::rectangle(0, 2, bottom, bottom + 1)
                                    : mesh::Box{{0, 0, bottom}, {2, 1, bottom + 1}};
      body.mesh.elements = {cells, cells, isPlane(kind) ? 0 : cells};
    }
    if (!isPlane(kind))
      body.supports = {{"symmetry", "front", {std::nullopt, 0.0}}};
    return body;
  }

  /// A block on a floor and one that a wall holds on its left, pressed on it and lifted at its right end: the
  /// joint opens there.
  Scene lifted(const test::Kind& kind, int order, double poissonsRatio = 0.3) const {
    Scene scene;
    scene.bodies = {block(kind, order, "lower", 0), block(kind, order, "upper", 1)};
    for (scene::Body& body : scene.bodies) {
      body.material.poissonsRatio = poissonsRatio;
      body.supports.push_back({"wall", "left", {0.0}});
    }
    const std::size_t up = isPlane(kind) ? 1 : 2;
    fem::SolidSupport floor{"floor", "bottom", {}};
    floor.value.at(up) = 0.0;
    scene.bodies[0].supports.push_back(floor);
    scene.bodies[1].supports.back().value.at(up) = -0.02;
    scene.bodies[1].loads = {{"weight", SolidLoad::Kind::body, {}, "", {0, 0, 0}, upwards(kind, -2)},
                             {"pull", SolidLoad::Kind::traction, {}, "top", {0, 0, 0}, upwards(kind, 1)}};
    scene.bodies[1].loads[0].box = mesh::Box{{-9, -9, -9}, {9, 9, 9}};
    scene.contacts = {test::between("joint", 0, "top", 1, "bottom")};
    return scene;
  }

  /// A block that a wall holds, pressed towards a plane below it, which it meets at its right end.
  Scene onPlane(const test::Kind& kind, int order) const {
    Scene scene;
    scene.bodies = {block(kind, order, "block", 0)};
    scene.bodies[0].supports.push_back({"wall", "left", {0.0, 0.0, 0.0}});
    scene.bodies[0].loads = {{"press", SolidLoad::Kind::pressure, {}, "top", {0, 0, 0}, {10, 0, 0}}};
    scene.contacts = {test::onPlane("floor", 0, "bottom", upwards(kind, -0.1), upwards(kind, 1))};
    return scene;
  }

  /// A block that is pulled at its top.
  Scene stretched(const test::Kind& kind = {}, int order = 1) const {
    Scene scene;
    scene.bodies = {block(kind, order, "strip", 0)};
    scene.bodies[0].supports.push_back({"wall", "left", {0.0}});
    scene.bodies[0].supports.push_back(test::slide("bottom"));
    scene.bodies[0].loads = {{"pull", SolidLoad::Kind::traction, {}, "top", {0, 0, 0}, upwards(kind, 3)}};
    return scene;
  }

  static Scene membranes(int elements, int order) {
    Scene scene = scene::modelProblem(true, 2, elements);
    for (scene::Body& body : scene.bodies)
      body.mesh.order = order;
    return scene;
  }

  /// By the solution on a mesh four times finer, in space two times, and its own bound, which tells what that
  /// lacks.
  void expectBounds(const std::string& name, const Scene& scene, double most) const {
    SCOPED_TRACE(name);
    const bool isSolid = scene.bodies[0].physics == Physics::elasticity3d;
    const SceneRun run = solve(scene), fine = solve(isSolid ? accuracy::refined(scene)
                                                            : accuracy::refined(accuracy::refined(scene)));
    ASSERT_TRUE(run.result.bound && fine.result.bound);
    const accuracy::EnergyBound &bound = *run.result.bound, &finer = *fine.result.bound;
    ASSERT_EQ(bound.failure, "");
    ASSERT_EQ(finer.failure, "");
    EXPECT_LE(bound.lower, finer.upper);
    EXPECT_GE(bound.upper, finer.upper);
    const double distance =
        accuracy::errorAgainst(fine.scene, *fine.decomposition, fine.solution.displacement,
                               *run.decomposition, run.solution.displacement)
            .energy;
    const double error = distance - finer.error; // of run at least
    EXPECT_GE(bound.error, error);
    const double effectivity = bound.error / std::hypot(distance, fine.error->discretisation);
    EXPECT_GE(effectivity, 0.999);
    EXPECT_LE(effectivity, most);
  }
};

TEST_F(GuaranteedBoundTest, HoldsForMembranes) {
  if (comm->getSize() > 1)
    GTEST_SKIP() << "bounds are the same on every number of ranks, as another test has it";
  for (const int order : {1, 2}) {
    expectBounds("membranes of order " + std::to_string(order), membranes(8, order), 1.2);
    // Loads that end inside of elements take most of it.
    expectBounds("loads beside the mesh, order " + std::to_string(order), membranes(6, order),
                 order == 1 ? 1.7 : 5.5);
  }
}

TEST_F(GuaranteedBoundTest, HoldsForElasticBlocks) {
  if (comm->getSize() > 1)
    GTEST_SKIP() << "bounds are the same on every number of ranks, as another test has it";
  for (const Physics physics : {Physics::planeStrain, Physics::planeStress})
    for (const CellType cell : {CellType::quadrilateral, CellType::triangle})
      for (const int order : {1, 2}) {
        const test::Kind kind{physics, cell};
        const std::string name = toString(physics) + ", " + toString(withOrder(cell, order));
        expectBounds(name + ", two blocks", lifted(kind, order), 2.1);
        expectBounds(name + ", a plane", onPlane(kind, order), 1.35);
      }
}

TEST_F(GuaranteedBoundTest, HoldsInSpace) {
  if (comm->getSize() > 1)
    GTEST_SKIP() << "bounds are the same on every number of ranks, as another test has it";
  const test::Kind bricks{Physics::elasticity3d, CellType::hexahedron},
      tetrahedra{Physics::elasticity3d, CellType::tetrahedron};
  expectBounds("bricks, two blocks", lifted(bricks, 1), 2);
  expectBounds("bricks, a plane", onPlane(bricks, 1), 1.4);
  expectBounds("quadratic bricks, two blocks", lifted(bricks, 2), 2);
  expectBounds("quadratic bricks, a plane", onPlane(bricks, 2), 1.4);
  // As coarse as these are, tetrahedra of order 1 have hardly any modes of tractions.
  expectBounds("tetrahedra, two blocks", lifted(tetrahedra, 1), 5.5);
  expectBounds("tetrahedra, a plane", onPlane(tetrahedra, 1), 3.5);
  expectBounds("quadratic tetrahedra, two blocks", lifted(tetrahedra, 2), 3);
  expectBounds("quadratic tetrahedra, a plane", onPlane(tetrahedra, 2), 2);
}

TEST_F(GuaranteedBoundTest, HoldsForRandomLoads) {
  if (comm->getSize() > 1)
    GTEST_SKIP() << "bounds are the same on every number of ranks, as another test has it";
  test::SignedRandomNumbers random(45);
  for (int i = 0; i < 8; ++i) {
    const test::Kind& kind = test::kinds()[i % 4];
    const int order = 1 + i / 4 % 2;
    Scene scene = i % 3 == 0 ? onPlane(kind, order) : lifted(kind, order, 0.24 + 0.25 * random());
    for (scene::Body& body : scene.bodies)
      for (SolidLoad& load : body.loads)
        for (int c = 0; c < (load.kind == SolidLoad::Kind::pressure ? 1 : componentsOf(kind.physics)); ++c)
          load.value.at(c) += 6 * random();
    expectBounds("scene " + std::to_string(i) + ", " + toString(withOrder(kind.cell, order)), scene, 20);
  }
}

/// What tolerances leave open and what quadratic edges overlap between their nodes counts.
TEST_F(GuaranteedBoundTest, HoldsForRoughIterations) {
  for (const int order : {1, 2}) {
    const Scene scene = membranes(8, order);
    const SceneRun exact = solve(scene), rough = solve(scene, 1e-2);
    const accuracy::EnergyBound &bound = *exact.result.bound, &wide = *rough.result.bound;
    ASSERT_EQ(wide.failure, "");
    EXPECT_GT(wide.upper - wide.lower, 1.01 * (bound.upper - bound.lower));
    EXPECT_LE(wide.lower, bound.upper);
    EXPECT_GE(wide.upper, bound.lower);
    EXPECT_GE(wide.error + bound.error,
              accuracy::errorAgainst(exact.scene, *exact.decomposition, exact.solution.displacement,
                                     *rough.decomposition, rough.solution.displacement)
                  .energy);
  }
}

TEST_F(GuaranteedBoundTest, IsTheSameOnEveryNumberOfRanks) {
  for (const test::Kind& kind : test::kinds()) {
    const Scene scene = lifted(kind, 2);
    const SceneRun here = solve(scene), alone = solve(scene, 1e-10, comm->split(comm->getRank(), 0));
    const accuracy::EnergyBound &bound = *here.result.bound, &same = *alone.result.bound;
    ASSERT_EQ(bound.failure, "");
    EXPECT_EQ(bound.steps, same.steps);
    EXPECT_NEAR(bound.error, same.error, 1e-6 * same.error);
    EXPECT_NEAR(bound.lower, same.lower, 1e-6 * (same.upper - same.lower));
    EXPECT_NEAR(bound.upper, same.upper, 1e-6 * (same.upper - same.lower));
  }
}

TEST_F(GuaranteedBoundTest, HasNoErrorWhereTheStressIsEven) {
  for (const test::Kind& kind : test::kinds())
    for (const int order : {1, 2}) {
      const SceneRun run = solve(stretched(kind, order));
      ASSERT_EQ(run.result.bound->failure, "");
      EXPECT_GT(run.result.bound->energyNorm, 1e-2);
      EXPECT_LE(run.result.bound->error, 1e-6 * run.result.bound->energyNorm) << toString(kind.cell) << order;
    }
}

TEST_F(GuaranteedBoundTest, RefusesWhatItDoesNotCover) {
  const auto expectRefusal = [&](const Scene& scene, const std::string& word) {
    try {
      solve(scene);
      ADD_FAILURE() << word;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  Scene scene = stretched();
  scene.bodies[0].loads.push_back({"heat", SolidLoad::Kind::temperature, {}, "", {0, 0, 0}, {5, 0, 0}});
  expectRefusal(scene, "temperature");
  scene = stretched();
  scene.bodies[0].loads.push_back(test::pointForce({2, 1, 0}, {1, 0, 0}));
  expectRefusal(scene, "forces at points");
  scene = stretched();
  scene.bodies[0].physics = Physics::axisymmetric;
  expectRefusal(scene, "axisymmetric");
  expectRefusal(scene::modelProblem(false, 2, 4), "supports hold");
}

} // namespace
} // namespace epafi::simulation
