#include "support/Preconditioned.hpp"

#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"
#include "epafi/fetidp/equilibrium/ProjectedOperator.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace epafi::fetidp {
namespace {

/// PMP + ρ⁻¹Q beside M, and P by dense algebra.
struct Projected {
  Projected(const scene::Scene& scene, const PreconditionerParameters& parameters, double penalty)
      : base(scene, parameters), m(matrixOf(base.m)),
        op(rcpFromRef(base.m), rcp(new NaturalCoarseSpace(base.problem, kernelConstraint(base.problem))),
           1 / penalty) {
    const Eigen::MatrixXd z = kernelOf(kernelRows(base.problem));
    p = z * z.transpose();
    q = Eigen::MatrixXd::Identity(p.rows(), p.rows()) - p;
  }

  Preconditioned base;
  Eigen::MatrixXd m, p, q;
  ProjectedOperator op;
};

constexpr double penalties[] = {0.01, 50};

TEST(ProjectedPreconditionerTest, IsPMPOnTheKernelOfGAndOneOverTheNormalPenaltyBesideIt) {
  for (const ContactCase& c : floatingCases())
    for (const double penalty : penalties) {
      SCOPED_TRACE(c.name + ", " + std::to_string(penalty));
      const Projected projected(c.scene, {}, penalty);
      const Eigen::MatrixXd a = matrixOf(projected.op);
      const Eigen::MatrixXd &p = projected.p, &q = projected.q;
      EXPECT_LE(relativeError(a, p * projected.m * p + q / penalty), 1e-12);
      EXPECT_LE(relativeError(a * q, q / penalty), 1e-12 * (1 + projected.m.norm() * penalty));
      EXPECT_GT(q.norm(), 0.9); // a body floats
    }
}

TEST(ProjectedPreconditionerTest, IsSymmetricPositiveDefinite) {
  for (const ContactCase& c : floatingCases())
    for (const PreconditionerParameters& parameters : allPreconditioners(false))
      for (const double penalty : penalties) {
        SCOPED_TRACE(c.name + "; " + describe(parameters) + ", " + std::to_string(penalty));
        const Eigen::MatrixXd a = matrixOf(Projected(c.scene, parameters, penalty).op);
        EXPECT_LE((a - a.transpose()).norm(), 1e-12 * a.norm());
        EXPECT_GT(scaledSpectrum(a).minCoeff(), 1e-4);
      }
}

TEST(ProjectedPreconditionerTest, ScalesAndAddsAsTpetraOperatorsDo) {
  const Projected projected(twoMembranes(false, 4, grid(2, 2)), {}, 2.0);
  const Eigen::MatrixXd a = matrixOf(projected.op);
  const Eigen::VectorXd x = randomVector(a.rows(), 1), y = randomVector(a.rows(), 2);
  const RCP<const Map> map = projected.op.getDomainMap();
  const RCP<Vector> input = spread(map, x), output = spread(map, y);

  projected.op.apply(*input, *output, Teuchos::NO_TRANS, 2.0, -3.0);
  EXPECT_LE(relativeError(gathered(*output), 2.0 * a * x - 3.0 * y), 1e-13);
  output->putScalar(std::numeric_limits<double>::quiet_NaN());
  projected.op.apply(*input, *output); // beta = 0 forgets what was there
  EXPECT_LE(relativeError(gathered(*output), a * x), 1e-13);
  EXPECT_EQ(gathered(*input), x);
}

} // namespace
} // namespace epafi::fetidp
