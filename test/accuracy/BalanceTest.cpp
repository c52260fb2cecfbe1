// The algebraic error: bounded by its estimate, and with the tolerance 'balanced' a fraction of the mesh's.

#include "Samples.hpp"

#include "support/Refusal.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>

namespace epafi::accuracy {
namespace {

using BalanceTest = test::AccuracyTest;

struct SolvedTo {
  scene::Scene scene;
  model::Decomposition decomposition;
  ContactSolver solver;
  fetidp::ContactSolution solution;

  SolvedTo(const scene::Scene& given, const Teuchos::ParameterList& parameters, const RCP<const Comm>& comm)
      : scene(given), decomposition(model::decompose(scene, comm)), solver(parameters) {
    solver.setup(decomposition.problem, decomposition.data);
    ErrorEstimator estimator(scene, decomposition);
    fetidp::ErrorBalance balance;
    balance.estimate = [&](std::span<const Eigen::VectorXd> u) { return estimator(u).toBalance(); };
    solution = solver.solve(decomposition.data, nullptr, nullptr, &balance);
  }
};

Teuchos::ParameterList tolerance(double value) {
  return Teuchos::ParameterList().set("Tolerance", value).set("Equilibrium Tolerance", value);
}

/// Broken energy norm of the difference of two solutions on the same subdomains.
double energyDistance(const SolvedTo& a, const SolvedTo& b) {
  std::vector<Eigen::VectorXd> difference = a.solution.displacement;
  for (std::size_t s = 0; s < difference.size(); ++s)
    difference[s] -= b.solution.displacement[s];
  return errorNorms(a.scene, a.decomposition, difference, {}).energy;
}

/// Scenes with all algorithms: MPRGP, SMALBE, CG.
std::vector<scene::Scene> scenes(const BalanceTest& fixture) {
  scene::Scene glued = test::membrane(16, 4);
  glued.bodies[0].loads.push_back(fem::loadInside("load", mesh::rectangle(0, 2, 0, 0.5), -1));
  return {scene::modelProblem(true, 3, 24), scene::modelProblem(false, 3, 24),
          test::stackedBlocks(test::kinds()[1], 5, 1, fixture.directory, *fixture.comm), glued};
}

TEST_F(BalanceTest, TheAlgebraicErrorIsNoLargerThanItsEstimateAndNotMuchSmaller) {
  for (const scene::Scene& scene : scenes(*this)) {
    const SolvedTo exact(scene, tolerance(1e-12), comm);
    for (const double value : {1e-1, 1e-2, 1e-4}) {
      const SolvedTo rough(scene, tolerance(value), comm);
      const double error = energyDistance(rough, exact);
      EXPECT_LE(error, 1.0001 * rough.solution.algebraicError + 1e-9 * exact.solution.algebraicError);
      EXPECT_LE(rough.solution.algebraicError, 3 * error + 1e-10) << value;
    }
  }
}

TEST_F(BalanceTest, StopsAtTheFractionThatWasAskedForAndSavesProducts) {
  for (const scene::Scene& scene : scenes(*this)) {
    const SolvedTo exact(scene, tolerance(1e-12), comm), fixed(scene, tolerance(1e-6), comm);
    const ErrorEstimate estimate =
        ErrorEstimator(exact.scene, exact.decomposition)(exact.solution.displacement);
    const double mesh = estimate.discretisation, energyNorm = estimate.energyNorm;
    for (const double fraction : {0.3, 0.1, 0.01}) {
      Teuchos::ParameterList parameters;
      parameters.set("Tolerance", std::string("balanced")).set("Algebraic Fraction", fraction);
      const SolvedTo balanced(scene, parameters, comm);
      EXPECT_EQ(balanced.solver.report().status, qp::Status::converged);
      EXPECT_LE(energyDistance(balanced, exact),
                1.1 * fraction * std::max(mesh, 1e-5 * energyNorm)); // a mesh without any error is let off

      EXPECT_LE(balanced.solver.report().counts.hessianMultiplications,
                fixed.solver.report().counts.hessianMultiplications + 1); // for its certificate
    }
  }
}

TEST_F(BalanceTest, IsRefusedWhereItCannotBeMeasured) {
  Teuchos::ParameterList parameters;
  parameters.set("Tolerance", std::string("balanced"));
  const auto decomposition = model::decompose(scene::modelProblem(true, 2, 4), comm);
  ContactSolver solver(parameters);
  solver.setup(decomposition.problem, decomposition.data);
  epafi::test::expectSays(epafi::test::refusal([&] { solver.solve(decomposition.data); }),
                          {"balanced", "discretisation error"});
  parameters.sublist("Preconditioner").set("Type", std::string("none"));
  epafi::test::expectSays(epafi::test::refusal([&] { const ContactSolver refused(parameters); }),
                          {"balanced", "preconditioner", "none"});
}

} // namespace
} // namespace epafi::accuracy
