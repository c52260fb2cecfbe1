// Elastic bodies: patch tests through a contact, whose answer linear elements have exactly.

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/Decompose.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace epafi {
namespace {

using scene::Physics;

/// How bodies are cut in a test.
struct Cut {
  std::string name;
  scene::Decomposition decomposition;
};

std::vector<Cut> cuts(int dimension) {
  std::vector<Cut> result;
  scene::Decomposition one, grid, metis;
  one.counts = {1, 1, 1};
  grid.counts = {2, 2, dimension == 3 ? 2 : 1};
  metis.method = scene::Decomposition::Method::metis;
  metis.parts = 5;
  return {{"one", one}, {"grid", grid}, {"metis", metis}};
}

/// A block that must not move through the planes x = 0 and, in space, y = 0.
scene::Body block(const std::string& name, Physics physics, double bottom, double top) {
  const bool isSolid = physics == Physics::elasticity3d;
  scene::Body body;
  body.name = name;
  scene::Solid solid;
  solid.physics = physics;
  solid.material = {1.0, 200.0, 0.3, 0.5};
  solid.mesh.box =
      isSolid ? scene::Box{{0, 0, bottom}, {1, 1, top}} : scene::Box{{0, bottom, 0}, {1, top, 0}};
  solid.mesh.elements = isSolid ? std::array<int, 3>{4, 4, 4} : std::array<int, 3>{6, 6, 0};
  solid.supports.push_back({"symmetry in x", "left", {0.0, std::nullopt, std::nullopt}});
  if (isSolid)
    solid.supports.push_back({"symmetry in y", "front", {std::nullopt, 0.0, std::nullopt}});
  body.solid = solid;
  return body;
}

/// Two blocks, one on the other; the lower one stands on a sliding floor, the upper one floats and is pressed down.
scene::Scene stackedBlocks(Physics physics, const scene::Decomposition& cut, double pressure) {
  const std::size_t up = physics == Physics::elasticity3d ? 2 : 1;
  scene::Scene scene;
  scene.bodies = {block("lower", physics, 0, 1), block("upper", physics, 1, 2)};
  scene::SolidSupport floor{"floor", "bottom", {}};
  floor.value[up] = 0.0;
  scene.bodies[0].solid->supports.push_back(floor);
  scene::SolidLoad press;
  press.name = "press";
  press.kind = scene::SolidLoad::Kind::pressure;
  press.where = "top";
  press.value[0] = pressure;
  scene.bodies[1].solid->loads.push_back(press);
  for (scene::Body& body : scene.bodies)
    body.decomposition = cut;
  scene::SurfaceContact contact;
  contact.name = "joint";
  contact.first = 0;
  contact.firstSurface = "top";
  contact.second = 1;
  contact.secondSurface = "bottom";
  scene.surfaceContacts.push_back(contact);
  return scene;
}

/// Strain along the stack and across it under a pressure of 1.
std::pair<double, double> strains(Physics physics, const scene::Material& material) {
  const double e = material.youngsModulus, nu = material.poissonsRatio;
  if (physics == Physics::planeStrain)
    return {-(1 - nu * nu) / e, nu * (1 + nu) / e};
  return {-1 / e, nu / e};
}

class PatchTest : public testing::TestWithParam<Physics> {};

TEST_P(PatchTest, StressIsConstantThroughTheContact) {
  const Physics physics = GetParam();
  const int components = componentsOf(physics);
  const double pressure = 3;
  for (const Cut& cut : cuts(components)) {
    SCOPED_TRACE(cut.name);
    const scene::Scene scene = stackedBlocks(physics, cut.decomposition, pressure);
    const auto decomposition = decomposition::decompose(scene, Tpetra::getDefaultComm());
    const decomposition::DecomposedProblem& problem = decomposition.problem;
    Teuchos::ParameterList parameters;
    parameters.set("Tolerance", 1e-12).set("Equilibrium Tolerance", 1e-12);
    ContactSolver solver(parameters);
    solver.setup(problem);
    const fetidp::ContactSolution solution = solver.solve();
    EXPECT_EQ(solver.report().status, qp::Status::converged) << solver.report().reason;
    EXPECT_EQ(problem.kernelDimension, 1);

    const scene::Material& material = scene.bodies[0].solid->material;
    const double thickness = components == 2 ? material.thickness : 1;
    EXPECT_NEAR(solution.contactForce, pressure * thickness, 1e-10);
    const auto multiplier = solution.multiplier->getData();
    for (Teuchos_Ordinal i = 0; i < multiplier.size(); ++i) {
      const auto row = problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i));
      if (row < problem.numInequalities) {
        EXPECT_NEAR(multiplier[i],
                    pressure * thickness * decomposition.contacts[0].areas[static_cast<std::size_t>(row)],
                    1e-10);
      }
    }
    const auto [along, across] = strains(physics, material);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
      const auto& subdomain = problem.subdomains[s];
      const fem::Mesh& mesh = *decomposition.bodies[static_cast<std::size_t>(subdomain.body)].mesh;
      for (std::size_t node = 0; node < subdomain.nodes.size(); ++node) {
        const fem::Point point = mesh.point(subdomain.nodes[node]);
        for (int c = 0; c < components; ++c) {
          const double strain = c + 1 == components ? along : across;
          EXPECT_NEAR(solution.displacement[s][static_cast<Eigen::Index>(node) * components + c],
                      pressure * strain * point[static_cast<std::size_t>(c)], 1e-10);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Solids, PatchTest,
                         testing::Values(Physics::planeStrain, Physics::planeStress, Physics::elasticity3d),
                         [](const auto& instance) {
                           return std::string(instance.param == Physics::planeStrain   ? "PlaneStrain"
                                              : instance.param == Physics::planeStress ? "PlaneStress"
                                                                                       : "Space");
                         });

} // namespace
} // namespace epafi
