// Multipliers that belong to displacements: of a solution they are its own, of a coarse one a good guess.

#include "Samples.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/accuracy/ContactTransfer.hpp"
#include "epafi/accuracy/Refinement.hpp"
#include "epafi/accuracy/Transfer.hpp"
#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <iterator>

namespace epafi::accuracy {
namespace {

using StartTest = test::AccuracyTest;

struct SolvedScene {
  model::Decomposition decomposition;
  ContactSolver solver;
  fetidp::ContactSolution solution;

  SolvedScene(const scene::Scene& scene, const RCP<const Comm>& comm, double tolerance = 1e-12)
      : decomposition(model::decompose(scene, comm)),
        solver(Teuchos::ParameterList().set("Tolerance", tolerance).set("Equilibrium Tolerance", tolerance)) {
    solver.setup(decomposition.problem, decomposition.data);
    solution = solver.solve(decomposition.data);
  }
};

/// ‖a − b‖/‖b‖
double largestDifference(const Vector& a, const Vector& b) {
  Vector difference(a, Teuchos::Copy);
  difference.update(-1.0, b, 1.0);
  return accurateNorm(difference) / accurateNorm(b);
}

TEST_F(StartTest, TheMultipliersOfASolutionAreItsOwn) {
  for (const bool coercive : {true, false}) {
    const SolvedScene solved(scene::modelProblem(coercive, 3, 12), comm);
    const RCP<const Vector> lambda =
        solved.solver.startFrom(solved.decomposition.data, solved.solution.displacement);
    EXPECT_LE(largestDifference(*lambda, *solved.solution.multiplier), 1e-9) << coercive;
  }
  for (const test::Kind& kind : test::kinds()) { // turned axes, averages along edges, floating bodies
    scene::Scene scene = test::stackedBlocks(kind, 6, 1, directory, *comm);
    scene.bodies[1].loads.push_back(
        {"corner", fem::SolidLoad::Kind::point, {}, "", {1, 1, 2}, {0.01, -0.02, 0.03}});
    if (mesh::dimensionOf(kind.cell) == 2)
      scene.bodies[1].loads.back().point = {1, 2, 0};
    const SolvedScene solved(scene, comm);
    const RCP<const Vector> lambda =
        solved.solver.startFrom(solved.decomposition.data, solved.solution.displacement);
    EXPECT_LE(largestDifference(*lambda, *solved.solution.multiplier), 1e-9) << toString(kind.physics);
  }
}

TEST_F(StartTest, ASolveFromThereIsShorterAndEndsAtTheSameSolution) {
  for (const bool coercive : {true, false}) {
    const scene::Scene scene = scene::modelProblem(coercive, 2, 16);
    const SolvedScene coarse(scene, comm, 1e-8), fine(refined(scene), comm, 1e-8);
    SolvedScene warm(refined(scene), comm, 1e-8);
    const RCP<Vector> start = warm.solver.startFrom(
        warm.decomposition.data, interpolate(coarse.decomposition, coarse.solution.displacement,
                                             warm.decomposition, NodesOf::interfaces));
    transferContact(coarse.decomposition, *coarse.solution.multiplier, warm.decomposition, *start);
    const fetidp::ContactSolution solution = warm.solver.solve(warm.decomposition.data, start.get());
    EXPECT_NEAR(solution.energy, fine.solution.energy, 1e-7 * std::abs(fine.solution.energy));
    EXPECT_LT(warm.solver.report().counts.hessianMultiplications,
              fine.solver.report().counts.hessianMultiplications);
  }
}

/// Places of rows with λ > 0, of this rank.
std::vector<LocalOrdinal> closedRows(const model::Decomposition& decomposition, const Vector& lambda) {
  std::vector<LocalOrdinal> closed;
  const auto values = lambda.getData();
  for (LocalOrdinal row = 0; row < values.size(); ++row)
    if (decomposition.problem.kindOf(decomposition::OwnedMultiplier(row)) ==
            decomposition::RowKind::contact &&
        values[row] > 0)
      closed.push_back(row);
  return closed;
}

/// Of this rank.
double sumOfContact(const model::Decomposition& decomposition, const Vector& lambda) {
  const auto values = lambda.getData();
  double sum = 0;
  for (const LocalOrdinal row : closedRows(decomposition, lambda))
    sum += values[row];
  return sum;
}

TEST_F(StartTest, ContactOnTheSameMeshIsItsOwn) {
  for (const test::Kind& kind : test::kinds()) {
    const SolvedScene solved(test::stackedBlocks(kind, 6, 1, directory, *comm), comm);
    const Vector& lambda = *solved.solution.multiplier;
    const double largest = lambda.normInf();
    Vector start(lambda.getMap());
    start.putScalar(-3.0);
    transferContact(solved.decomposition, lambda, solved.decomposition, start);
    const auto values = start.getData(), own = lambda.getData();
    for (LocalOrdinal row = 0; row < values.size(); ++row)
      if (solved.decomposition.problem.kindOf(decomposition::OwnedMultiplier(row)) ==
          decomposition::RowKind::contact)
        EXPECT_NEAR(values[row], std::max(0.0, own[row]), 1e-12 * largest) << toString(kind.physics);
      else
        EXPECT_EQ(values[row], -3.0); // not of contact
  }
}

TEST_F(StartTest, FrictionOnTheSameMeshIsItsOwn) {
  constexpr double mu = 0.3, nearlyAll = 0.99; // from there on a node is taken to slip
  for (const test::Kind& kind : test::kinds()) {
    scene::Scene scene = test::stackedBlocks(kind, 6, 1, directory, *comm);
    if (scene.bodies[0].physics == fem::Physics::membrane)
      continue;
    scene.contacts[0].friction = mu;
    scene.bodies[1].loads.push_back( // equal blocks that are pressed alone need no friction
        {"corner", fem::SolidLoad::Kind::point, {}, "", {1, 1, 2}, {0.01, -0.02, 0.03}});
    if (mesh::dimensionOf(kind.cell) == 2)
      scene.bodies[1].loads.back().point = {1, 2, 0};
    const SolvedScene solved(scene, comm);
    const Vector& lambda = *solved.solution.multiplier;
    Vector start(lambda.getMap());
    transferContact(solved.decomposition, lambda, solved.decomposition, start);
    const auto values = start.getData(), own = lambda.getData();
    const double rounding = 1e-12 * lambda.normInf();
    double largest = 0;
    for (const decomposition::FrictionNode& node : solved.decomposition.problem.frictionNodes)
      for (int k = 0; k < solved.decomposition.problem.components - 1; ++k) {
        const double bound = mu * std::max(0.0, own[node.contact]);
        EXPECT_NEAR(values[node.firstTangent + k], own[node.firstTangent + k],
                    (1 - nearlyAll) * bound + rounding)
            << toString(kind.physics);
        largest = std::max(largest, std::abs(own[node.firstTangent + k]) - (1 - nearlyAll) * bound);
      }
    EXPECT_GT(maxOverRanks(*comm, largest), 0) << toString(kind.physics); // there is some
  }
}

TEST_F(StartTest, ActiveSetsStartNearTheZoneOfACoarserMesh) {
  const scene::Scene scene = scene::modelProblem(false, 2, 16);
  const SolvedScene coarse(scene, comm), fine(refined(scene), comm);
  Vector start(fine.solution.multiplier->getMap());
  transferContact(coarse.decomposition, *coarse.solution.multiplier, fine.decomposition, start);
  EXPECT_NEAR(sumOverRanks(*comm, sumOfContact(fine.decomposition, start)), coarse.solution.contactForce,
              0.1 * coarse.solution.contactForce);
  const auto guessed = closedRows(fine.decomposition, start),
             found = closedRows(fine.decomposition, *fine.solution.multiplier);
  std::vector<LocalOrdinal> different;
  std::set_symmetric_difference(guessed.begin(), guessed.end(), found.begin(), found.end(),
                                std::back_inserter(different));
  EXPECT_LE(sumOverRanks(*comm, static_cast<int>(different.size())), 4);
}

} // namespace
} // namespace epafi::accuracy
