#include "support/Reference.hpp"
#include "support/Refusal.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace epafi::fetidp {
namespace {

/// Membranes whose data do not depend on y.
scene::Scene strips(bool coercive, double first, double second, const scene::Decomposition& cut,
                    int elements = 4) {
  scene::Scene scene = twoMembranes(coercive, elements, cut);
  setLoad(scene.bodies[0], first);
  setLoad(scene.bodies[1], second);
  return scene;
}

/// Cuts that a mesh of 4 × 4 elements allows.
std::vector<scene::Decomposition> cuts() {
  return {grid(1, 1), grid(2, 2), grid(4, 1), metis(3)};
}

/// Checks u along x = 1 and the total force against the closed form −u₁'' = f₁, −u₂'' = f₂.
void expectClosedForm(const Solved& solved, double u1, double u2, double force) {
  EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
  const Field field = fieldOf(solved.decomposition, solved.solution);
  const char* const edges[] = {"right", "left"};
  const double expected[] = {u1, u2};
  for (std::size_t b = 0; b < 2; ++b)
    for (const GlobalOrdinal node : solved.decomposition.bodies[b].mesh->surface(edges[b]).facetNodes)
      EXPECT_NEAR(field[b][node], expected[b], 1e-9);
  EXPECT_NEAR(solved.solution.contactForce, force, 1e-9);
  EXPECT_LE(solved.solution.feasibility, 1e-9);
}

TEST(DegenerateTest, HeldStripsFollowTheClosedForm) {
  for (const auto& cut : cuts())
    for (const auto& [first, second] : {std::pair(1.0, -1.0), std::pair(-1.0, 1.0), std::pair(3.0, 2.0),
                                        std::pair(-1.0, -1.0), std::pair(2.0, 2.0), std::pair(0.0, -4.0)}) {
      SCOPED_TRACE(testing::Message() << cut.counts[0] << ' ' << cut.parts << ": " << first << ' ' << second);
      const double force = std::max(0.0, (first - second) / 4); // equal loads: they touch with no force
      expectClosedForm(Solved(strips(true, first, second, cut)), first / 2 - force, second / 2 + force,
                       force);
    }
}

TEST(DegenerateTest, AFloatingStripFollowsTheClosedForm) {
  for (const auto& cut : cuts())
    for (const auto& [first, second] : {std::pair(0.0, -1.0), std::pair(-3.0, -0.5), std::pair(5.0, -2.0)}) {
      SCOPED_TRACE(testing::Message() << cut.counts[0] << ' ' << cut.parts << ": " << first << ' ' << second);
      const double u = first / 2 + second;
      expectClosedForm(Solved(strips(false, first, second, cut)), u, u, -second);
    }
}

TEST(DegenerateTest, OneRowOfElementsNeedsNoIteration) {
  // By symmetry λ̃ = Gᵀe is the solution: Pd vanishes, and with it what residuals are relative to.
  scene::Scene scene = strips(false, 1.0, -2.0, grid(1, 1));
  for (scene::Body& body : scene.bodies)
    body.mesh.elements = {4, 1, 0};
  const Solved solved(scene);
  expectClosedForm(solved, -1.5, -1.5, 2.0);
  EXPECT_LE(solved.solver.report().counts.hessianMultiplications, 10);
}

TEST(DegenerateTest, NothingHappensWithoutLoad) {
  for (const auto& cut : cuts()) {
    Solved solved(strips(true, 0.0, 0.0, cut));
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    EXPECT_EQ(solved.solution.energy, 0);
    for (const Eigen::VectorXd& u : fieldOf(solved.decomposition, solved.solution))
      EXPECT_EQ(u.norm(), 0);
  }
}

TEST(DegenerateTest, ALoadThatVanishesLeavesNothingOfAWarmStart) {
  for (const bool contact : {true, false}) {
    scene::Scene scene = strips(true, 1.0, -1.0, grid(2, 2));
    if (!contact)
      scene.contacts.clear();
    Solved solved(scene);
    solved.decomposition.data.scaleLoads(0);
    const ContactSolution rest =
        solved.solver.solve(solved.decomposition.data, solved.solution.multiplier.get());
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    for (const Eigen::VectorXd& u : fieldOf(solved.decomposition, rest))
      EXPECT_LE(u.norm(), 1e-12);
  }
}

TEST(DegenerateTest, AllContactsMayBeClosed) {
  for (const auto& cut : cuts()) {
    scene::Scene scene = strips(true, 100.0, -100.0, cut);
    setHalves(scene.bodies[0], 100.0, 80.0);
    const Solved solved(scene);
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    EXPECT_EQ(solved.solution.activeContactNodes, 5);
    EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution),
                         solveUndecomposed(solved.decomposition).field),
              1e-9);
  }
}

TEST(DegenerateTest, NoContactMayBeClosed) {
  for (const auto& cut : cuts()) {
    scene::Scene scene = strips(true, 1.0, -1.0, cut);
    scene.contacts.front().gap = 10;
    const Solved solved(scene);
    expectClosedForm(solved, 0.5, -0.5, 0.0); // u₂ − u₁ = −1 ≥ −10
    EXPECT_EQ(solved.solution.activeContactNodes, 0);
  }
}

TEST(DegenerateTest, AnInitialPenetrationIsPushedApart) {
  for (const auto& cut : cuts()) {
    scene::Scene scene = strips(true, 0.0, 0.0, cut);
    scene.contacts.front().gap = -1.0; // u₂ − u₁ ≥ 1
    expectClosedForm(Solved(scene), -0.5, 0.5, 0.5);
  }
}

TEST(DegenerateTest, WhatIsUnevenByLessThanTheRoundingOfALargeShiftIsSolvedToThatRounding) {
  // The floating strip moves by 1e4; what differs along the contact is 1e-5 of the load.
  scene::Scene scene = strips(false, 0, -1, grid(1, 1), 1);
  scene.contacts[0].gap = -1e4;
  scene.bodies[1].loads.push_back(fem::loadInside("uneven", mesh::rectangle(1, 2, 0, 0.25), -1e-5));
  const Solved solved(scene);
  EXPECT_EQ(solved.solver.report().status, qp::Status::converged) << solved.solver.report().reason;
  EXPECT_NEAR(solved.solution.contactForce, 1 + 0.25e-5, 1e-9);
  const double tolerance = 1e-11;
  EXPECT_GT(solved.solution.roundOff, tolerance) << "else it is no such case";
  EXPECT_LE(solved.solution.relativeProjectedGradient, 2 * solved.solution.roundOff);
  if (solved.solution.relativeProjectedGradient > 2 * tolerance) { // as it is here: nothing else is claimed
    EXPECT_NE(solved.solver.report().reason.find("rounding"), std::string::npos);
  }
}

TEST(DegenerateTest, ContactNodesMayBeSupportedOnBothSides) {
  for (const double gap : {0.0, 0.125})
    for (const auto& cut : cuts()) {
      SCOPED_TRACE(testing::Message() << gap << ' ' << cut.counts[0] << ' ' << cut.parts);
      scene::Scene scene = strips(true, 5.0, -5.0, cut);
      scene.contacts.front().gap = gap;
      for (scene::Body& body : scene.bodies) { // the foot's contact row is empty, the head's one-sided
        body.supports.push_back({"foot", "bottom", {0.0}});
      }
      scene.bodies[0].supports.push_back({"head", "top", {0.0}});
      const Solved solved(scene);
      EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
      EXPECT_EQ(gathered(*solved.solution.multiplier)[0], 0);
      EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution),
                           solveUndecomposed(solved.decomposition).field),
                1e-9);
    }
}

TEST(DegenerateTest, NeighboursThatOverlapInASupportAreRefused) {
  scene::Scene scene = strips(true, 1.0, -1.0, grid(2, 2));
  for (scene::Body& body : scene.bodies)
    body.supports = {{"foot", "bottom", {body.name == "left" ? 1.0 : 0.0}}};
  EXPECT_THROW(Solved{scene}, SolvabilityError);
}

TEST(DegenerateTest, ABodyBetweenTwoOthersIsHeldFromBothSides) {
  for (const auto& cut : {grid(1, 1), grid(2, 1), metis(2)})
    for (const double load : {-1.0, 1.0, 1e-5}) {
      SCOPED_TRACE(testing::Message() << cut.counts[0] << ' ' << cut.parts << ' ' << load);
      scene::Scene scene = threeMembranes(false, 4, cut);
      setHalves(scene.bodies[1], 4.0 + load, -4.0 + load);
      const Solved solved(scene);
      EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
      const PrimalSolution reference = solveUndecomposed(solved.decomposition);
      ASSERT_LE(reference.violation, 1e-12);
      EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), reference.field), 1e-8);
    }
}

TEST(DegenerateTest, ABalancedLoadIsHeldByTwoContacts) {
  // Resultant zero: e vanishes, and with it what the imbalance is relative to; the contacts carry force all
  // the same.
  for (const auto& cut : {grid(1, 1), grid(2, 1), metis(2)}) {
    scene::Scene scene = threeMembranes(false, 4, cut);
    setLoad(scene.bodies[0], 1.0);
    setHalves(scene.bodies[1], 4.0, -4.0);
    const Solved solved(scene);
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    const PrimalSolution reference = solveUndecomposed(solved.decomposition);
    ASSERT_LE(reference.violation, 1e-12);
    ASSERT_GT(reference.force.maxCoeff(), 1e-3);
    EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), reference.field), 1e-8);
  }
}

TEST(DegenerateTest, ABodyThatRestsLooselyBetweenTwoOthersIsNotUnique) {
  for (const double width : {1e-9, 1.0, 1e9}) {
    scene::Scene scene = threeMembranes(false, 4, grid(2, 1));
    for (scene::Body& body : scene.bodies)
      setLoad(body, 0.0);
    scene.contacts[0].gap = -width;    // at least this much above the first one,
    scene.contacts[1].gap = 3 * width; // at most that much above the last one
    test::expectSays(test::unsolvable(SolvabilityError::Kind::notUnique, [&] { const Solved solved(scene); }),
                     {"'middle'"});
  }
}

TEST(DegenerateTest, ABodyWithoutLoadMayBeHeldByItsNeighbours) {
  for (const auto& cut : {grid(1, 1), grid(2, 1)}) {
    scene::Scene scene = threeMembranes(false, 4, cut); // at rest: zero load, zero gaps
    for (scene::Body& body : scene.bodies)
      setLoad(body, 0.0);
    const Solved rest(scene);
    EXPECT_EQ(rest.solver.report().status, qp::Status::converged);
    for (const Eigen::VectorXd& u : fieldOf(rest.decomposition, rest.solution))
      EXPECT_EQ(u.norm(), 0);

    setLoad(scene.bodies[0], 1.0); // squeezed
    setLoad(scene.bodies[2], -1.0);
    const Solved squeezed(scene);
    EXPECT_EQ(squeezed.solver.report().status, qp::Status::converged);
    EXPECT_LE(fieldError(fieldOf(squeezed.decomposition, squeezed.solution),
                         solveUndecomposed(squeezed.decomposition).field),
              1e-8);
    scene.contacts[0].gap = -1.0; // without room: exactly one place
    scene.contacts[1].gap = 1.0;
    for (const std::size_t body : {0U, 2U})
      setLoad(scene.bodies[body], 0.0);
    const Solved lifted(scene);
    expectClosedForm(lifted, 0.0, 1.0, 0.0);
  }
}

TEST(DegenerateTest, AChainOfFloatingBodiesIsHeldByItsLastLoad) {
  for (const auto& cut : {grid(1, 1), grid(2, 1), metis(2)}) {
    scene::Scene scene = threeMembranes(true, 4, cut);
    setLoad(scene.bodies[1], 0.5);
    const Solved solved(scene);
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    EXPECT_NEAR(solved.solution.contactForce, 1.0 + 0.5,
                1e-9); // 1 on the last one, 1 − 0.5 on the middle one
    EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution),
                         solveUndecomposed(solved.decomposition).field),
              1e-8);
  }
}

TEST(DegenerateTest, ABodyThatIsHardlyPressedIsHeldAllTheSame) {
  for (const double resultant : {1e-4, 1e-6, 1e-8}) {
    scene::Scene scene = strips(false, 1.0, 0.0, grid(2, 2));
    setHalves(scene.bodies[1], 1.0 - resultant, -1.0 - resultant);
    const Solved solved(scene, 1e-6);
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged) << resultant;
    EXPECT_NEAR(solved.solution.contactForce, resultant, 1e-3 * resultant) << resultant;
    EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution),
                         solveUndecomposed(solved.decomposition).field),
              1e-4)
        << resultant << ' ' << solved.solver.report().counts.outer << ' '
        << solved.solver.report().counts.hessianMultiplications;
  }
}

} // namespace
} // namespace epafi::fetidp
