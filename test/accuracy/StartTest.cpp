// Multipliers that belong to displacements: of a solution they are its own, of a coarse one a good guess.

#include "Samples.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/accuracy/Refinement.hpp"
#include "epafi/accuracy/Transfer.hpp"
#include "epafi/base/AccurateSum.hpp"

#include <Tpetra_Vector.hpp>

namespace epafi::accuracy {
namespace {

using StartTest = test::AccuracyTest;

struct Solved {
  model::Decomposition decomposition;
  ContactSolver solver;
  fetidp::ContactSolution solution;

  Solved(const scene::Scene& scene, const RCP<const Comm>& comm, double tolerance = 1e-12,
         const std::string& algorithm = "auto")
      : decomposition(model::decompose(scene, comm)), solver(Teuchos::ParameterList()
                                                                 .set("Tolerance", tolerance)
                                                                 .set("Equilibrium Tolerance", tolerance)
                                                                 .set("Algorithm", algorithm)) {
    solver.setup(decomposition.problem);
    solution = solver.solve();
  }
};

/// ‖a − b‖/‖b‖
double distance(const Vector& a, const Vector& b) {
  Vector difference(a, Teuchos::Copy);
  difference.update(-1.0, b, 1.0);
  return accurateNorm(difference) / accurateNorm(b);
}

TEST_F(StartTest, TheMultipliersOfASolutionAreItsOwn) {
  for (const bool coercive : {true, false}) {
    const Solved solved(scene::modelProblem(coercive, 3, 12), comm);
    const RCP<const Vector> lambda = solved.solver.startFrom(solved.solution.displacement);
    EXPECT_LE(distance(*lambda, *solved.solution.multiplier), 1e-9) << coercive;
  }
  for (const test::Kind& kind : test::kinds()) { // turned axes, averages along edges, floating bodies
    scene::Scene scene = test::stackedBlocks(kind, 6, 1, directory, *comm);
    scene.bodies[1].loads.push_back(
        {"corner", scene::SolidLoad::Kind::point, {}, "", {1, 1, 2}, {0.01, -0.02, 0.03}});
    if (fem::dimensionOf(kind.cell) == 2)
      scene.bodies[1].loads.back().point = {1, 2, 0};
    const Solved solved(scene, comm);
    const RCP<const Vector> lambda = solved.solver.startFrom(solved.solution.displacement);
    EXPECT_LE(distance(*lambda, *solved.solution.multiplier), 1e-9) << toString(kind.physics);
  }
}

TEST_F(StartTest, ASolveFromThereIsShorterAndEndsAtTheSameSolution) {
  for (const bool coercive : {true, false}) {
    const scene::Scene scene = scene::modelProblem(coercive, 2, 16);
    const std::string method =
        "MPRGP"; // active sets begin with all contact closed, which is as good a start here
    const Solved coarse(scene, comm, 1e-8, method), fine(refined(scene), comm, 1e-8, method);
    Solved warm(refined(scene), comm, 1e-8, method);
    const RCP<const Vector> start = warm.solver.startFrom(interpolate(
        coarse.decomposition, coarse.solution.displacement, warm.decomposition, NodesOf::interfaces));
    const fetidp::ContactSolution solution = warm.solver.solve(start.get());
    EXPECT_NEAR(solution.energy, fine.solution.energy, 1e-7 * std::abs(fine.solution.energy));
    EXPECT_LT(warm.solver.report().counts.hessianMultiplications,
              fine.solver.report().counts.hessianMultiplications);
  }
}

} // namespace
} // namespace epafi::accuracy
