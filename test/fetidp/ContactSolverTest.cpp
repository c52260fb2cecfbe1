#include "support/DataChanges.hpp"
#include "support/Reference.hpp"
#include "support/Refusal.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <memory>

namespace epafi::fetidp {
namespace {

scene::Scene membranes(bool coercive) {
  scene::Scene scene = twoMembranes(coercive, 6, grid(2, 2));
  setHalves(scene.bodies[0], 4.0, -5.0);
  setHalves(scene.bodies[1], -3.0, 2.0);
  return scene;
}

/// Of the same problem, or one with the same subdomains.
double changeOf(const Solved& solved, const ContactSolution& again) {
  return fieldError(fieldOf(solved.decomposition, again), fieldOf(solved.decomposition, solved.solution));
}

TEST(ContactSolverTest, SolvesAgainForNewLoadsAndGaps) {
  for (const bool coercive : {true, false}) {
    Solved solved(membranes(coercive));
    const DecomposedProblem& problem = solved.decomposition.problem;
    const Field before = fieldOf(solved.decomposition, solved.solution);
    decomposition::ProblemData& data = solved.decomposition.data;
    data = withLoads(data, [&](std::size_t s, Eigen::VectorXd& load) {
      load *= problem.subdomains[s].body == 0 ? 3.0 : 1.5;
    });
    const RCP<Vector> gaps = data.contactGaps(problem);
    for (const GlobalOrdinal row : localIndices(*gaps->getMap()))
      gaps->replaceGlobalValue(row, 0.01 * static_cast<double>(row));
    data.setGaps(*gaps);
    const ContactSolution again = solved.solver.solve(solved.decomposition.data);
    const Field after = fieldOf(solved.decomposition, again);
    EXPECT_LE(fieldError(after, solveUndecomposed(solved.decomposition).field), 1e-8);
    EXPECT_GT(fieldError(after, before), 0.1); // it is another problem

    ContactSolver fresh(toleranceOf(1e-11));
    fresh.setup(problem, data);
    EXPECT_LE(fieldError(after, fieldOf(solved.decomposition, fresh.solve(data))), 1e-13);
  }
}

TEST(ContactSolverTest, SolvingTwiceGivesTheSameAnswer) {
  for (const bool coercive : {true, false}) {
    Solved solved(membranes(coercive));
    const ContactSolution again = solved.solver.solve(solved.decomposition.data);
    EXPECT_EQ(relativeError(gathered(*again.multiplier), gathered(*solved.solution.multiplier)), 0);
  }
}

TEST(ContactSolverTest, ALoadMayAppearAfterSetup) {
  scene::Scene scene = membranes(false);
  const Solved loaded(scene);
  for (scene::Body& body : scene.bodies)
    body.loads.clear();
  auto decomposition = decompose(scene, world());
  ContactSolver solver(toleranceOf(1e-10));
  solver.setup(decomposition.problem, decomposition.data); // not unique as yet
  EXPECT_THROW(solver.solve(decomposition.data), SolvabilityError);
  EXPECT_LE(changeOf(loaded, solver.solve(loaded.decomposition.data)), 1e-9);
}

TEST(ContactSolverTest, AWarmStartFromTheSolutionTakesFewProducts) {
  for (const bool coercive : {true, false}) {
    Solved solved(membranes(coercive), 1e-8);
    const int cold = solved.solver.report().counts.hessianMultiplications;
    const ContactSolution again =
        solved.solver.solve(solved.decomposition.data, solved.solution.multiplier.get());
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    EXPECT_LE(solved.solver.report().counts.hessianMultiplications, 3);
    EXPECT_GT(cold, 6);
    EXPECT_LE(changeOf(solved, again), 1e-7);
  }
}

TEST(ContactSolverTest, AnyStartLeadsToTheSolution) {
  for (const bool coercive : {true, false}) {
    Solved solved(membranes(coercive));
    const DecomposedProblem& problem = solved.decomposition.problem;
    const auto start =
        spread(problem.multiplierMap, randomVector(static_cast<Eigen::Index>(problem.dualDimension()), 3));
    const Eigen::VectorXd kept = gathered(*start);
    const ContactSolution again = solved.solver.solve(solved.decomposition.data, start.get());
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    EXPECT_LE(changeOf(solved, again), 1e-8);
    EXPECT_EQ(gathered(*start), kept);
  }
}

TEST(ContactSolverTest, ChoosesTheLeastAlgorithm) {
  const fem::SolidSupport wall{"wall", "left", {0.0}};
  const auto algorithmOf = [](const scene::Scene& scene) {
    return Solved(scene, 1e-6).solver.dualProblem().algorithm();
  };
  EXPECT_EQ(algorithmOf(decomposition::oneBody(4, 4, grid(1, 1), {wall})), Algorithm::direct);
  EXPECT_EQ(algorithmOf(decomposition::oneBody(4, 4, grid(2, 2), {wall})), Algorithm::conjugateGradient);
  EXPECT_EQ(algorithmOf(membranes(true)), Algorithm::mprgp);
  EXPECT_EQ(algorithmOf(membranes(false)), Algorithm::activeSets);
}

TEST(ContactSolverTest, EveryAlgorithmFindsTheSameSolution) {
  for (const bool held : {true, false}) {
    std::vector<double> energies;
    for (const char* algorithm : {"MPRGP", "active set"}) {
      const auto decomposition = decompose(membranes(held), world());
      ContactSolver solver(Teuchos::ParameterList().set("Algorithm", algorithm).set("Tolerance", 1e-10));
      solver.setup(decomposition.problem, decomposition.data);
      const ContactSolution solution = solver.solve(decomposition.data);
      EXPECT_EQ(solver.report().status, qp::Status::converged) << solver.report().reason;
      EXPECT_EQ(solver.dualProblem().algorithm() == Algorithm::activeSets,
                algorithm == std::string("active set"));
      EXPECT_LE(solution.relativeProjectedGradient, 2e-10);
      EXPECT_LE(solution.equilibrium, 1e-12);
      energies.push_back(solution.energy);
    }
    EXPECT_NEAR(energies[0], energies[1], 1e-9 * std::abs(energies[0]));
  }
}

TEST(ContactSolverTest, BodiesWithoutContactAreSolvedToo) {
  const fem::SolidSupport wall{"wall", "left", {0.5}}, foot{"foot", "bottom", {0.5}};
  for (const auto& cut : {grid(1, 1), grid(2, 2), metis(3)}) {
    const Solved solved(decomposition::oneBody(4, 5, cut, {wall, foot}));
    const PrimalSolution reference = solveUndecomposed(solved.decomposition);
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), reference.field), 1e-9);
    EXPECT_NEAR(solved.solution.energy, reference.energy, 1e-9 * std::abs(reference.energy));
    EXPECT_EQ(solved.solution.contactForce, 0);
  }
}

TEST(ContactSolverTest, SolveAsksForSetup) {
  ContactSolver solver(ContactSolver::validParameters());
  EXPECT_THROW(solver.solve({}), Error);
}

TEST(ContactSolverTest, AFailedSetupLeavesNoHalfSolver) {
  Solved solved(membranes(false), 1e-6);
  scene::Scene adrift = membranes(false);
  adrift.bodies.push_back(adrift.bodies[1]);
  adrift.bodies.back().name = "adrift";
  const auto decomposition = decompose(adrift, world());
  EXPECT_THROW(solved.solver.setup(decomposition.problem, decomposition.data), SolvabilityError);
  EXPECT_THROW(solved.solver.solve(solved.decomposition.data), Error); // not the old problem's answer
  solved.solver.setup(solved.decomposition.problem, solved.decomposition.data);
  EXPECT_EQ(gathered(*solved.solver.solve(solved.decomposition.data).multiplier),
            gathered(*solved.solution.multiplier));
}

TEST(ContactSolverTest, UnknownAndImpossibleParametersAreRefused) {
  const auto complaint = [](const auto& change) {
    Teuchos::ParameterList list;
    change(list);
    return test::refusal([&] { ContactSolver{list}; });
  };
  test::expectSays(complaint([](auto& list) { list.set("Tolerence", 1e-6); }), {"Tolerence", "Tolerance"});
  test::expectSays(complaint([](auto& list) { list.set("Tolerance", -1.0); }), {"Tolerance", "-1"});
  test::expectSays(complaint([](auto& list) { list.sublist("MPRGP").set("Expansion Step", 2.5); }),
                   {"MPRGP", "Expansion Step", "2.5"});
  test::expectSays(complaint([](auto& list) { list.sublist("Direct Solvers").set("Subdomains", "KLU3"); }),
                   {"Subdomains", "KLU3", "KLU2"});
}

TEST(ContactSolverTest, AMissedToleranceIsAStatusNotAnError) {
  for (const bool coercive : {true, false}) {
    const auto decomposition = decompose(membranes(coercive), world());
    Teuchos::ParameterList list;
    list.sublist("MPRGP").set("Maximum Multiplications", 3);
    ContactSolver solver(list);
    solver.setup(decomposition.problem, decomposition.data);
    const ContactSolution solution = solver.solve(decomposition.data);
    EXPECT_EQ(solver.report().status, qp::Status::maxIterations);
    EXPECT_EQ(solver.facts().status, qp::Status::maxIterations);
    EXPECT_GT(solution.relativeProjectedGradient, solver.plan().tolerance);
  }
}

constexpr std::array notFinite{std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()};

TEST(ContactSolverTest, LoadsAndGapsThatAreNoNumbersAreRefused) {
  for (const bool coercive : {true, false})
    for (const double bad : notFinite) {
      Solved solved(membranes(coercive), 1e-6);
      const DecomposedProblem& problem = solved.decomposition.problem;
      const auto complaint = [&](const decomposition::ProblemData& data) {
        return test::refusal([&] { solved.solver.solve(data); });
      };
      const auto loaded = withLoads(solved.decomposition.data, [&](std::size_t s, Eigen::VectorXd& load) {
        if (problem.subdomains[s].number == 5)
          load[0] = bad; // on one rank; all ranks say so
      });
      test::expectSays(complaint(loaded), {"load", "'right'", "subdomain 5"});
      const auto apart = changed(solved.decomposition.data, [&](const auto& /*subdomains*/, Vector& gap) {
        if (problem.multiplierMap->isNodeGlobalElement(2))
          gap.replaceGlobalValue(2, bad);
      });
      test::expectSays(complaint(apart), {"gap", "contact row 2"});
      test::expectSays(test::refusal([&] { ContactSolver(Teuchos::ParameterList()).setup(problem, apart); }),
                       {"gap", "contact row 2"});
    }
}

TEST(ContactSolverTest, ABodyThatHardlyAnythingHoldsIsSolvedToItsDisplacements) {
  // Held by springs of 1e-8, the right body makes ‖d̃‖ 1e8 times as large as any displacement of the
  // solution.
  scene::Scene scene = membranes(true);
  scene::Body& right = scene.bodies[1];
  mesh::Box strip = right.mesh.box;
  strip.lower[0] = strip.upper[0] - (strip.upper[0] - strip.lower[0]) / right.mesh.elements[0];
  right.regions = {{"springs", strip, "", {1e-8}}};
  setLoad(right, -1.0);
  const Solved solved(scene, 1e-8);
  EXPECT_EQ(solved.solver.report().status, qp::Status::converged) << solved.solver.report().reason;
  const PrimalSolution reference = solveUndecomposed(solved.decomposition);
  EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), reference.field), 1e-5);
  EXPECT_LE(solved.solution.feasibility, 1e-5);
  const auto& history = solved.solver.report().history; // one history of all that was done
  for (std::size_t i = 1; i < history.size(); ++i) {
    EXPECT_GE(history[i].iteration, history[i - 1].iteration);
    EXPECT_GE(history[i].hessianMultiplications, history[i - 1].hessianMultiplications);
  }
  EXPECT_LE(history.back().hessianMultiplications, solved.solver.report().counts.hessianMultiplications);
}

TEST(ContactSolverTest, RowsThatContradictEachOtherHaveNoSolution) {
  for (const auto& cut : {grid(1, 1), grid(2, 2), metis(3)}) {
    scene::Scene scene = membranes(true);
    for (scene::Body& body : scene.bodies)
      body.decomposition = cut;
    auto decomposition = decompose(scene, world());
    DecomposedProblem& problem = decomposition.problem;
    for (auto& subdomain : problem.subdomains) { // row 1 becomes −(row 0), which leaves no room for both
      auto& entries = subdomain.constraint;
      const int first = problem.multiplierGhostMap->getLocalElement(0),
                second = problem.multiplierGhostMap->getLocalElement(1);
      std::erase_if(entries, [&](const auto& entry) { return second >= 0 && entry.multiplier == second; });
      const auto kept = entries;
      for (const auto& entry : kept)
        if (first >= 0 && second >= 0 && entry.multiplier == first)
          entries.push_back({second, entry.unknown, -entry.coefficient});
    }
    decomposition.data = changed(decomposition.data, [&](const auto& /*subdomains*/, Vector& gap) {
      if (problem.multiplierMap->isNodeGlobalElement(1))
        gap.replaceGlobalValue(1, -1.0);
    });
    ContactSolver solver(toleranceOf(1e-8));
    solver.setup(problem, decomposition.data);
    test::expectSays(
        test::unsolvable(SolvabilityError::Kind::noSolution, [&] { solver.solve(decomposition.data); }),
        {"contradict", "gap"});
  }
}

/// What setup says, on every rank, of a problem whose subdomain 5 was changed.
std::string complaintAbout(bool coercive, const std::function<void(decomposition::Subdomain&)>& change) {
  auto decomposition = decompose(membranes(coercive), world());
  for (auto& subdomain : decomposition.problem.subdomains)
    if (subdomain.number == 5)
      change(subdomain);
  ContactSolver solver(toleranceOf(1e-6));
  return test::refusal([&] { solver.setup(decomposition.problem, decomposition.data); });
}

TEST(ContactSolverTest, WhatIsNoNumberInOneSubdomainIsRefusedOnAllRanks) {
  for (const bool coercive : {true, false})
    for (const double bad : notFinite) {
      for (const int place : {0, 1, 3}) { // an infinite one would pass for a support
        const auto spoil = [&](decomposition::Subdomain& subdomain) {
          auto matrix = std::make_shared<decomposition::SparseMatrix>(*subdomain.stiffness);
          matrix->coeffRef(place, place) = bad;
          subdomain.stiffness = matrix;
        };
        const std::string number = std::to_string(place);
        test::expectSays(complaintAbout(coercive, spoil),
                         {"stiffness", "'right'", "subdomain 5", "row " + number + ", column " + number});
      }
      test::expectSays(
          complaintAbout(coercive,
                         [bad](auto& subdomain) { subdomain.constraint.front().coefficient = bad; }),
          {"row", "coefficient", "'right'", "subdomain 5"});
    }
}

/// Stops a solve at a step, on the last rank, and looks at every step.
class Stopping final : public qp::Observer {
public:
  explicit Stopping(int stopAt) : stopAt_(stopAt) {}
  void step(const qp::StepRecord& /*record*/) override { ++steps_; }
  bool wantsToStop() override { return isLast_ && steps_ >= stopAt_; }
  bool wantsToLook() override { return isLast_; }
  void look(const Vector& lambda) override { seen = gathered(lambda); }
  Eigen::VectorXd seen;

private:
  bool isLast_ = world()->getRank() == world()->getSize() - 1;
  int steps_ = 0, stopAt_;
};

TEST(ContactSolverTest, AnInterruptedSolveGoesOnFromWhatItsObserverSaw) {
  scene::Scene unheld = membranes(true); // no contact: CG
  unheld.contacts.clear();
  for (const scene::Scene& scene : {membranes(true), membranes(false), unheld}) {
    const Solved whole(scene);
    Solved half(scene, 1e-11);
    Stopping observer(4);

    const ContactSolution stopped = half.solver.solve(half.decomposition.data, nullptr, &observer);

    EXPECT_EQ(half.solver.report().status, qp::Status::interrupted);
    EXPECT_EQ(observer.seen, gathered(*stopped.multiplier));
    EXPECT_GT(stopped.relativeProjectedGradient, half.solver.plan().tolerance);
    const RCP<Vector> start = spread(half.decomposition.problem.multiplierMap, observer.seen);
    const ContactSolution rest = half.solver.solve(half.decomposition.data, start.get());
    EXPECT_EQ(half.solver.report().status, qp::Status::converged);
    EXPECT_LE(changeOf(whole, rest), 1e-9);
  }
}

TEST(ContactSolverTest, FactsSayWhatWasSolvedAndHow) {
  const Solved solved(membranes(false), 1e-6);
  const SolveFacts facts = solved.solver.facts();
  EXPECT_EQ(facts.dualDimension, facts.numEqualities + facts.numInequalities);
  EXPECT_EQ(facts.numInequalities, 7);
  EXPECT_EQ(facts.numSubdomains, 8);
  EXPECT_EQ(facts.floatingBodies.size(), 1U);
  EXPECT_EQ(facts.kernelDimension, 1);
  EXPECT_EQ(facts.numRanks, world()->getSize());
  EXPECT_EQ(facts.status, qp::Status::converged);
  EXPECT_FALSE(facts.statusReason.empty());
  EXPECT_EQ(facts.counts.hessianMultiplications, solved.solver.report().counts.hessianMultiplications);
  EXPECT_GT(facts.factorBytes, 0);
  EXPECT_GE(facts.peakBytes, facts.factorBytes);
  EXPECT_GE(facts.times.setup, 0);
}

} // namespace
} // namespace epafi::fetidp
