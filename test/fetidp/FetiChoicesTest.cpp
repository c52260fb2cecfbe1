// Whatever FETI-DP is told to do, the solution is that of the problem.

#include "support/Preconditioned.hpp"
#include "support/Reference.hpp"

#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

/// What can be chosen, as in the parameter list.
struct Choice {
  std::string mode, type, share, precision;
};

std::string nameOf(const Choice& choice) {
  return choice.mode + ", " + choice.type + ", shared: " + choice.share + ", " + choice.precision;
}

std::vector<Choice> allChoices() {
  std::vector<Choice> choices;
  for (const char* mode : {"implicit", "explicit"})
    for (const char* type : {"none", "lumped", "dirichlet"})
      for (const char* share : {"yes", "no"})
        for (const char* precision : {"double", "single"})
          choices.push_back({mode, type, share, precision});
  return choices;
}

Teuchos::ParameterList parametersOf(const Choice& choice, double tolerance = 1e-10) {
  Teuchos::ParameterList list = toleranceOf(tolerance);
  list.sublist("Dual Operator").set("Mode", choice.mode);
  list.sublist("Preconditioner").set("Type", choice.type).set("Precision", choice.precision);
  list.sublist("Direct Solvers").set("Share Identical Subdomains", choice.share);
  return list;
}

/// Pressed together below, apart above.
scene::Scene membranes(bool coercive, const scene::Decomposition& cut, double gap = 0) {
  scene::Scene scene = twoMembranes(coercive, 8, cut);
  setHalves(scene.bodies[0], 4.0, -5.0);
  setHalves(scene.bodies[1], -3.0, 2.0);
  scene.contacts.front().gap = gap;
  return scene;
}

TEST(FetiChoicesTest, EveryChoiceLeadsToTheUndecomposedSolution) {
  const std::vector<ContactCase> cases{{"coercive", membranes(true, grid(4, 4)), true},
                                       {"semicoercive", membranes(false, grid(4, 4)), false},
                                       {"coercive with a gap", membranes(true, grid(2, 2), 0.02), true},
                                       {"semicoercive with a gap", membranes(false, grid(2, 2), 0.02), false},
                                       {"semicoercive, METIS", membranes(false, metis(5)), false}};
  for (const ContactCase& c : cases) {
    const auto decomposition = decompose(c.scene, world());
    const PrimalSolution reference = solveUndecomposed(decomposition);
    ASSERT_LE(reference.violation, 1e-10);
    for (const Choice& choice : allChoices()) {
      SCOPED_TRACE(c.name + "; " + nameOf(choice));
      ContactSolver solver(parametersOf(choice));
      solver.setup(decomposition.problem, decomposition.data);
      const ContactSolution solution = solver.solve(decomposition.data);
      EXPECT_EQ(solver.report().status, qp::Status::converged) << solver.report().reason;
      EXPECT_LE(fieldError(fieldOf(decomposition, solution), reference.field), 1e-8);
      EXPECT_NEAR(solution.energy, reference.energy, 1e-9 * std::abs(reference.energy));
      EXPECT_EQ(solver.report().counts.preconditionerApplications > 0, choice.type != "none");
    }
  }
}

/// Products with F for a scene.
int products(const scene::Scene& scene, const std::string& type) {
  const auto decomposition = decompose(scene, world());
  ContactSolver solver(parametersOf({"explicit", type, "yes", "double"}, 1e-8));
  solver.setup(decomposition.problem, decomposition.data);
  const ContactSolution solution = solver.solve(decomposition.data);
  EXPECT_EQ(solver.report().status, qp::Status::converged) << type;
  EXPECT_LE(solution.relativeProjectedGradient, 1e-8);
  return solver.report().counts.hessianMultiplications;
}

TEST(FetiChoicesTest, ConjugateGradientsWithoutContactTakeFewerProductsWithAPreconditioner) {
  for (const auto& cut : {grid(4, 4), metis(7)}) {
    scene::Scene scene = decomposition::oneBody(32, 32, cut, {{"wall", "left", {0.0}}});
    setHalves(scene.bodies[0], 1.0, -3.0); // else u depends on x alone
    const int none = products(scene, "none"), lumped = products(scene, "lumped"),
              dirichlet = products(scene, "dirichlet");
    EXPECT_LT(lumped, none) << cut.parts;
    EXPECT_LT(dirichlet, lumped) << cut.parts;
  }
}

TEST(FetiChoicesTest, ContactTakesFewerProductsWithAPreconditioner) {
  for (const bool coercive : {true, false}) {
    scene::Scene scene = twoMembranes(coercive, 32, grid(2, 2));
    setHalves(scene.bodies[0], 4.0, -5.0);
    setHalves(scene.bodies[1], -3.0, 2.0);
    const int none = products(scene, "none"), dirichlet = products(scene, "dirichlet");
    EXPECT_LT(dirichlet, 0.7 * none) << coercive;
  }
}

TEST(FetiChoicesTest, ConductivityThatJumpsDoesNotSpoilTheSolution) {
  for (const ContactCase& c : hardCases()) {
    if (c.name.find("jumps") == std::string::npos)
      continue;
    scene::Scene scene = c.scene;
    setHalves(scene.bodies[0], 4.0, -5.0);
    setHalves(scene.bodies[1], -3.0, 2.0);
    const auto decomposition = decompose(scene, world());
    const PrimalSolution reference = solveUndecomposed(decomposition);
    ASSERT_LE(reference.violation, 1e-8) << c.name;
    for (const char* type : {"none", "lumped", "dirichlet"}) {
      SCOPED_TRACE(c.name + "; " + type);
      ContactSolver solver(parametersOf({"implicit", type, "yes", "double"}));
      solver.setup(decomposition.problem, decomposition.data);
      const ContactSolution solution = solver.solve(decomposition.data);
      EXPECT_EQ(solver.report().status, qp::Status::converged) << solver.report().reason;
      EXPECT_LE(fieldError(fieldOf(decomposition, solution), reference.field), 1e-6);
    }
  }
}

} // namespace
} // namespace epafi::fetidp
