#include "support/Reference.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/solve/Recovery.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

/// c − B̄u from the subdomains' matrices and the solution alone. Collective.
Eigen::VectorXd slackFrom(const Solved& solved) {
  const DecomposedProblem& problem = solved.decomposition.problem;
  SubdomainVectors u;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const auto& positions = problem.subdomains[s].unknownPosition;
    u.emplace_back(solved.solution.displacement[s](positions));
  }
  const DenseProblem dense = densify(problem, solved.decomposition.data);
  return dense.gap - dense.constraint * mergeValues(problem, u);
}

/// λ of contact and the slack of its rows.
struct ContactRows {
  explicit ContactRows(const Solved& solved)
      : number(static_cast<Eigen::Index>(solved.decomposition.problem.numInequalities)),
        force(gathered(*solved.solution.multiplier).head(number)), slack(slackFrom(solved).head(number)) {}
  Eigen::Index number;
  Eigen::VectorXd force, slack;
};

TEST(RecoveryTest, EqualsTheUndecomposedSolution) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene);
    const PrimalSolution reference = solveUndecomposed(solved.decomposition);
    ASSERT_LE(reference.violation, 1e-12);
    EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
    EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), reference.field), 1e-9);
    EXPECT_NEAR(solved.solution.energy, reference.energy, 1e-9 * std::abs(reference.energy));
    EXPECT_LE(relativeError(ContactRows(solved).force, reference.force), 1e-7);
    EXPECT_EQ(solved.solution.activeContactNodes,
              (reference.force.array() > 1e-9 * reference.force.maxCoeff()).count());
  }
}

TEST(RecoveryTest, GluesTheSubdomains) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene);
    double largest = 0;
    for (const Eigen::VectorXd& u : fieldOf(solved.decomposition, solved.solution))
      largest = std::max(largest, u.lpNorm<Eigen::Infinity>());
    EXPECT_LE(largestJump(solved.decomposition, solved.solution), 1e-9 * largest);
    const Eigen::Index gluing = solved.decomposition.problem.numEqualities;
    EXPECT_LE(slackFrom(solved).tail(gluing).norm(), 1e-9 * largest); // B_E u = 0
  }
}

TEST(RecoveryTest, KeepsTheContactConditions) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const ContactRows rows{Solved(c.scene)};
    const double length = rows.slack.lpNorm<Eigen::Infinity>(), force = rows.force.maxCoeff();
    ASSERT_GT(force, 0);
    ASSERT_GT(length, 0); // some contact is open, some closed
    for (Eigen::Index i = 0; i < rows.number; ++i) {
      EXPECT_GE(rows.force[i], 0) << i;
      EXPECT_GE(rows.slack[i], -1e-8 * length) << i;
      EXPECT_LE(std::min(rows.force[i] / force, rows.slack[i] / length), 1e-8) << i;
    }
  }
}

TEST(RecoveryTest, ReportsTheSlackAndTheActiveSetOfItsSolution) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene, 1e-4);
    const Eigen::VectorXd slack = slackFrom(solved), active = gathered(*solved.solution.active);
    EXPECT_LE((gathered(*solved.solution.slack) - slack).norm(), 1e-13 * slack.norm() + 1e-15);
    EXPECT_EQ(active.sum(), static_cast<double>(solved.solution.activeContactNodes));
    const Eigen::Index numContacts = solved.decomposition.problem.numInequalities;
    for (Eigen::Index i = 0; i < active.size(); ++i)
      EXPECT_TRUE(active[i] == 0 || (active[i] == 1 && i < numContacts)) << i;
  }
}

TEST(RecoveryTest, CertificatesAreTheResidualsOfTheSolution) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene, 1e-3); // loose, so that the residuals are no round-off
    const ContactSolution& solution = solved.solution;
    const DenseProblem dense = densify(solved.decomposition.problem, solved.decomposition.data);
    const ContactRows rows(solved);
    const Eigen::VectorXd slack = slackFrom(solved), lambda = gathered(*solution.multiplier);

    double violation = std::max(0.0, (-rows.slack).maxCoeff());
    for (Eigen::Index i = rows.number; i < slack.size(); ++i) // jumps, whatever rows multiply them by
      violation = std::max(violation, std::abs(slack[i]) / dense.constraint.row(i).lpNorm<Eigen::Infinity>());
    double length = dense.gap.lpNorm<Eigen::Infinity>();
    for (const Eigen::VectorXd& u : fieldOf(solved.decomposition, solution))
      length = std::max(length, u.lpNorm<Eigen::Infinity>());
    EXPECT_NEAR(solution.feasibility, violation / length, 1e-3 * solution.feasibility);
    EXPECT_NEAR(solution.complementarity, std::abs(rows.force.dot(rows.slack) / solution.energy),
                1e-9 * solution.complementarity + 1e-16);

    Eigen::VectorXd projected = slack; // the gradient of the dual problem
    for (Eigen::Index i = 0; i < rows.number; ++i)
      if (rows.force[i] == 0)
        projected[i] = std::min(slack[i], 0.0);
    const Eigen::MatrixXd plus = pseudoInverse(dense.stiffness), bt = dense.constraint.transpose();
    Eigen::VectorXd d = dense.constraint * (plus * dense.load) - dense.gap; // d̃
    if (dense.kernel.cols() > 0) {
      const Eigen::MatrixXd gt = dense.constraint * dense.kernel,
                            inverse = pseudoInverse(gt.transpose() * gt);
      const Eigen::VectorXd load = dense.kernel.transpose() * dense.load;
      d -= dense.constraint * (plus * (bt * (gt * (inverse * load)))); // d̃ − Fλ̃
      d -= gt * (inverse * (gt.transpose() * d));                      // P
      EXPECT_LE(solution.equilibrium, 1e-3);
      EXPECT_LE((gt.transpose() * lambda - load).norm(), 1e-3 * 2 * load.norm());
    }
    EXPECT_NEAR(solution.relativeProjectedGradient, projected.norm() / d.norm(),
                1e-6 * solution.relativeProjectedGradient);
    if (dense.kernel.cols() == 0) {
      EXPECT_LE(solution.relativeProjectedGradient, 1e-3 * (1 + 1e-9));
    }
  }
}

TEST(RecoveryTest, EnergyIsThatOfTheSolution) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene, 1e-2);
    double energy = 0;
    for (std::size_t s = 0; s < solved.decomposition.problem.subdomains.size(); ++s) {
      const auto& subdomain = solved.decomposition.problem.subdomains[s];
      const Eigen::VectorXd u = solved.solution.displacement[s](subdomain.unknownPosition);
      energy += 0.5 * u.dot(*subdomain.stiffness * u) -
                solved.decomposition.data.subdomains()[s].rightHandSide().dot(u);
    }
    energy = sumOverRanks(*world(), energy);
    EXPECT_NEAR(solved.solution.energy, energy, 1e-13 * std::abs(energy));
  }
}

TEST(RecoveryTest, ClosedRowsAreClosedByAResponse) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene, 1e-3); // loose: something is open
    DualSolution found;
    found.lambda = solved.solution.multiplier;
    found.report.status = qp::Status::converged;
    const DecomposedProblem& problem = solved.decomposition.problem;
    qp::SolveReport report;
    const auto settling = recoverSettled(solved.solver.dualProblem(), solved.decomposition.data, found,
                                         {1e-12}, report, qp::Interruption(0));
    ASSERT_TRUE(settling);
    const ContactSolution& settled = *settling;
    const Eigen::VectorXd closed = gathered(*solved.solution.active),
                          before = gathered(*solved.solution.slack), after = gathered(*settled.slack);
    double open = 0, left = 0;
    for (Eigen::Index row = 0; row < closed.size(); ++row)
      if (row >= problem.numInequalities || closed[row] > 0) {
        open = std::max(open, std::abs(before[row]));
        left = std::max(left, std::abs(after[row]));
      } else {
        EXPECT_EQ(gathered(*settled.multiplier)[row], gathered(*found.lambda)[row]) << row;
      }
    EXPECT_GT(open, 0);
    EXPECT_LE(left, 1e-6 * open + 1e-15);

    const DenseProblem dense = densify(problem, solved.decomposition.data);
    SubdomainVectors u;
    double energy = 0;
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
      const auto& subdomain = problem.subdomains[s];
      u.emplace_back(decomposition::unknownsOf(subdomain, settled.displacement[s]));
      energy += 0.5 * u[s].col(0).dot(*subdomain.stiffness * u[s].col(0)) -
                solved.decomposition.data.subdomains()[s].rightHandSide().dot(u[s].col(0));
    }
    energy = sumOverRanks(*world(), energy);
    const Eigen::VectorXd merged = mergeValues(problem, u), lambda = gathered(*settled.multiplier);
    const Eigen::VectorXd imbalance =
        dense.stiffness * merged + dense.constraint.transpose() * lambda - dense.load;
    EXPECT_LE(imbalance.norm(),
              (c.coercive ? 1e-11 : 1e-3) * dense.load.norm()); // Gλ = e is as loose as the solution
    EXPECT_NEAR(settled.energy, energy, (c.coercive ? 1e-12 : 1e-6) * std::abs(energy));
  }
}

TEST(RecoveryTest, ClosedRowsAreFoundFromWrongOnes) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene);
    if (solved.decomposition.problem.kernelDimension > 0) // any other λ would be out of balance
      continue;
    const PrimalSolution reference = solveUndecomposed(solved.decomposition);
    for (const double push : {1e-6, -1.0}) { // all contacts, or none
      DualSolution found;
      found.lambda = rcp(new Vector(*solved.solution.multiplier, Teuchos::Copy));
      found.report.status = qp::Status::converged;
      for (double& force : found.lambda->getDataNonConst())
        force += push * std::abs(force) + std::max(push, 0.0) * reference.force.maxCoeff();
      qp::SolveReport report;
      const auto settled = recoverSettled(solved.solver.dualProblem(), solved.decomposition.data, found,
                                          {1e-12}, report, qp::Interruption(0));
      ASSERT_TRUE(settled);
      EXPECT_LE(fieldError(fieldOf(solved.decomposition, *settled), reference.field), 1e-8);
      EXPECT_NEAR(settled->energy, reference.energy, 1e-8 * std::abs(reference.energy));
      EXPECT_LE(relativeError(gathered(*settled->multiplier).head(reference.force.size()), reference.force),
                1e-7);
    }
  }
}

/// A wish of the last rank, or the time limit, ends it on all.
TEST(RecoveryTest, SettlingEndsWhereOneRankWantsIt) {
  class OnLastRank final : public qp::Observer {
  public:
    void step(const qp::StepRecord& /*record*/) override {}
    [[nodiscard]] bool wantsToStop() override { return world()->getRank() == world()->getSize() - 1; }
  };
  const Solved solved(contactCases().front().scene, 1e-3);
  DualSolution found;
  found.lambda = solved.solution.multiplier;
  found.report.status = qp::Status::converged;
  OnLastRank observer;
  qp::Interruption wanted(0), late(1e-9);
  wanted.setObserver(&observer);
  for (const auto& [interruption, status] :
       {std::pair(&wanted, qp::Status::interrupted), {&late, qp::Status::timeLimit}}) {
    qp::SolveReport report;
    EXPECT_FALSE(recoverSettled(solved.solver.dualProblem(), solved.decomposition.data, found, {1e-12},
                                report, *interruption));
    EXPECT_EQ(report.status, status);
    EXPECT_EQ(report.counts.hessianMultiplications, 0);
  }
}

TEST(RecoveryTest, ContactForcesBalanceTheLoadOfAFloatingBody) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene);
    const ContactRows rows(solved);
    EXPECT_NEAR(solved.solution.contactForce, rows.force.sum(), 1e-13 * rows.force.sum());
    if (c.scene.contacts.size() == 1 && !c.coercive) { // halves loaded by −3 and 2
      EXPECT_NEAR(solved.solution.contactForce, 0.5, 1e-9);
    }
    if (!c.coercive) {
      EXPECT_LE(solved.solution.equilibrium, 1e-12); // restored to round-off
    }
  }
}

TEST(RecoveryTest, SupportsKeepTheirValues) {
  scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
  scene.bodies[0].supports.front().value[0] = 0.25;
  scene.bodies[1].supports.front().value[0] = -0.5; // 0.75 too low: pressed together
  const Solved solved(scene);
  const PrimalSolution reference = solveUndecomposed(solved.decomposition);
  const Field field = fieldOf(solved.decomposition, solved.solution);
  ASSERT_LE(reference.violation, 1e-12);
  EXPECT_LE(fieldError(field, reference.field), 1e-9);
  for (Eigen::Index j = 0; j < 5; ++j) {
    EXPECT_EQ(field[0][5 * j], 0.25);
    EXPECT_EQ(field[1][5 * j + 4], -0.5);
  }
  EXPECT_NEAR(solved.solution.energy, reference.energy, 1e-9 * std::abs(reference.energy));
}

} // namespace
} // namespace epafi::fetidp
