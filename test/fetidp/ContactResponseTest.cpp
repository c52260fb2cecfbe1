// Responses to changes of loads and gaps beside differences of two solutions.

#include "support/DataChanges.hpp"
#include "support/Reference.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace epafi::fetidp {
namespace {

/// Of all loads and gaps, as large as these are, the same on any number of ranks.
DataChange someChange(const DecomposedProblem& problem, double loadSize, double gapSize) {
  DataChange change;
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    Eigen::VectorXd& load = change.load.emplace_back(subdomain.stiffness->rows());
    for (Eigen::Index i = 0; i < load.size(); ++i)
      load[i] = loadSize * std::sin(static_cast<double>(i));
  }
  const RCP<Vector> gap = rcp(new Vector(problem.multiplierMap));
  {
    const auto values = gap->getDataNonConst();
    for (LocalOrdinal row = 0; row < values.size(); ++row)
      if (problem.multiplierMap->getGlobalElement(row) < problem.numInequalities)
        values[row] = gapSize * std::cos(static_cast<double>(problem.multiplierMap->getGlobalElement(row)));
  }
  change.gap = gap;
  return change;
}

double largest(const std::vector<Eigen::VectorXd>& u, const Comm& comm) {
  double result = 0;
  for (const Eigen::VectorXd& values : u)
    result = std::max(result, values.size() > 0 ? values.lpNorm<Eigen::Infinity>() : 0.0);
  return maxOverRanks(comm, result);
}

TEST(ContactResponseTest, IsTheDerivativeOfTheSolution) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    Solved solved(c.scene, 1e-12);
    const DecomposedProblem& problem = solved.decomposition.problem;
    double load = 0;
    for (const auto& data : solved.decomposition.data.subdomains())
      load = std::max(load, data.load.size() > 0 ? data.load.lpNorm<Eigen::Infinity>() : 0.0);
    const double length = largest(solved.solution.displacement, *world());
    const DataChange change = someChange(problem, maxOverRanks(*world(), load), 0.01 * length);
    const ContactResponse response = solved.solver.respond(solved.solution, change, 1e-11);
    EXPECT_EQ(response.report.status, qp::Status::converged);

    constexpr double s = 1e-4;
    double work = 0; // ḟᵀu
    for (std::size_t i = 0; i < problem.subdomains.size(); ++i)
      work += change.load[i].dot(
          decomposition::unknownsOf(problem.subdomains[i], solved.solution.displacement[i]));
    work = sumOverRanks(*world(), work) + change.gap->dot(*solved.solution.multiplier);
    const decomposition::ProblemData data =
        changed(solved.decomposition.data, [&](auto& subdomains, Vector& gap) {
          for (std::size_t i = 0; i < subdomains.size(); ++i)
            subdomains[i].load += s * change.load[i];
          gap.update(s, *change.gap, 1.0);
        });
    const ContactSolution moved = solved.solver.solve(data, solved.solution.multiplier.get());
    Vector zone(*moved.active, Teuchos::Copy);
    zone.update(-1.0, *solved.solution.active, 1.0);
    ASSERT_EQ(zone.normInf(), 0); // else there is nothing to compare

    std::vector<Eigen::VectorXd> difference;
    for (std::size_t i = 0; i < moved.displacement.size(); ++i)
      difference.emplace_back((moved.displacement[i] - solved.solution.displacement[i]) / s -
                              response.displacement[i]);
    EXPECT_LE(largest(difference, *world()), 1e-6 * largest(response.displacement, *world()));
    Vector forces(*moved.multiplier, Teuchos::Copy);
    forces.update(-1.0, *solved.solution.multiplier, 1.0);
    EXPECT_LE(forces.norm2(), 1.001 * s * response.multiplier->norm2());
    forces.update(-s, *response.multiplier, 1.0);
    EXPECT_LE(forces.norm2(), 1e-5 * s * response.multiplier->norm2());
    EXPECT_NEAR((moved.energy - solved.solution.energy) / s, -work, 1e-2 * std::abs(work)); // envelope
  }
}

/// All gaps of the last contact of a chain move by 1: the floating body behind follows as a whole.
TEST(ContactResponseTest, ABodyThatFollowsItsContactAsAWholeHasNoForces) {
  for (const ContactCase& c : contactCases()) {
    if (c.scene.bodies.size() != 2 || c.coercive)
      continue;
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene);
    const DecomposedProblem& problem = solved.decomposition.problem;
    DataChange change = someChange(problem, 0, 0);
    const RCP<Vector> gap = rcp(new Vector(problem.multiplierMap));
    for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(gap->getLocalLength()); ++row)
      if (problem.multiplierMap->getGlobalElement(row) < problem.numInequalities)
        gap->replaceLocalValue(row, 1.0);
    change.gap = gap;
    const ContactResponse response = solved.solver.respond(solved.solution, change, 1e-11);
    EXPECT_LE(response.multiplier->normInf(), 1e-10);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
      for (const double u : response.displacement[s]) // one of the bodies floats
        EXPECT_NEAR(std::abs(u), problem.bodies[problem.subdomains[s].body].kernelDimension, 1e-9);
  }
}

TEST(ContactResponseTest, HoldsClosedContactsAndLeavesOpenOnesAlone) {
  bool pulls = false;
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Solved solved(c.scene);
    const DecomposedProblem& problem = solved.decomposition.problem;
    DataChange change = someChange(problem, 1, 0);
    change.gap = Teuchos::null;
    const ContactResponse response = solved.solver.respond(solved.solution, change, 1e-11);
    const Eigen::VectorXd active = gathered(*solved.solution.active), force = gathered(*response.multiplier);
    SubdomainVectors u;
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
      u.emplace_back(decomposition::unknownsOf(problem.subdomains[s], response.displacement[s]));
    const DenseProblem dense = densify(problem);
    const Eigen::VectorXd jump = dense.constraint * mergeValues(problem, u);
    const double length = largest(response.displacement, *world());
    for (Eigen::Index row = 0; row < force.size(); ++row) {
      const bool isContact = row < static_cast<Eigen::Index>(problem.numInequalities);
      if (!isContact || active[row] > 0)
        EXPECT_LE(std::abs(jump[row]), 1e-8 * length) << row;
      else
        EXPECT_EQ(force[row], 0) << row;
      pulls = pulls || (isContact && force[row] < 0);
    }
  }
  EXPECT_TRUE(pulls); // joints, not contacts
}

} // namespace
} // namespace epafi::fetidp
