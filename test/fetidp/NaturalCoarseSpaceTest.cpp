#include "support/DenseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"
#include "epafi/fetidp/equilibrium/ProjectedOperator.hpp"
#include "epafi/fetidp/operator/DualOperator.hpp"
#include "epafi/fetidp/solve/DualProblem.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace epafi::fetidp {
namespace {

/// The floating cases, their G̃ as a dense matrix.
struct Floating {
  explicit Floating(const scene::Scene& scene, GramInverse::Form form = GramInverse::Form::automatic)
      : decomposition(decompose(scene, world())), problem(decomposition.problem), map(problem.multiplierMap),
        space(rcp(new NaturalCoarseSpace(problem, kernelConstraint(problem), form))) {}

  /// P as a matrix.
  Eigen::MatrixXd projector() const {
    const Eigen::Index n = problem.dualDimension();
    Eigen::MatrixXd p(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const RCP<Vector> x = spread(map, Eigen::VectorXd::Unit(n, j));
      space->project(*x);
      p.col(j) = gathered(*x);
    }
    return p;
  }
  /// G̃ as a matrix.
  Eigen::MatrixXd rows() const {
    const Eigen::Index n = problem.dualDimension();
    Eigen::MatrixXd g(space->size(), n);
    for (Eigen::Index j = 0; j < n; ++j)
      g.col(j) = space->product(*spread(map, Eigen::VectorXd::Unit(n, j)));
    return g;
  }

  model::Decomposition decomposition;
  const DecomposedProblem& problem;
  RCP<const Map> map;
  RCP<const NaturalCoarseSpace> space;
};

TEST(NaturalCoarseSpaceTest, KernelConstraintIsTheKernelSeenByTheConstraints) {
  for (const ContactCase& c : floatingCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    const DecomposedProblem& problem = decomposition.problem;
    const DenseProblem dense = densify(problem);
    Eigen::MatrixXd found = Eigen::MatrixXd::Zero(dense.constraint.rows(), problem.kernelDimension);
    for (const KernelEntry& entry : kernelConstraint(problem))
      found(static_cast<Eigen::Index>(problem.multiplierMap->getGlobalElement(entry.row)), entry.mode) +=
          entry.value;
    sumOverRanks(*problem.comm, {found.data(), static_cast<std::size_t>(found.size())});
    EXPECT_LE((found - dense.constraint * dense.kernel).norm(), 1e-14); // B̄R, nothing in the rows of gluing
    EXPECT_GT(found.norm(), 1);
  }
}

TEST(NaturalCoarseSpaceTest, KernelLoadIsTheResultantOfEachFloatingBody) {
  scene::Scene scene = threeMembranes(true, 4, metis(3));
  setLoad(scene.bodies[1], 2.0);
  setLoad(scene.bodies[2], -0.5);
  const auto decomposition = decompose(scene, world());
  const Eigen::VectorXd resultants = kernelLoad(decomposition.problem, decomposition.data);
  ASSERT_EQ(resultants.size(), 2);
  EXPECT_NEAR(resultants[0], 2.0, 1e-14); // load × area 1 × mode 1
  EXPECT_NEAR(resultants[1], -0.5, 1e-14);
}

TEST(NaturalCoarseSpaceTest, RowsAreTheKernelConstraintWeighedByTheInverseOfTheirGram) {
  for (const ContactCase& c : floatingCases())
    for (const auto form : {GramInverse::Form::sparse, GramInverse::Form::spread}) {
      SCOPED_TRACE(c.name);
      const Floating floating(c.scene, form);
      EXPECT_EQ(floating.space->gramInverse().isSpread(), form == GramInverse::Form::spread);
      const Eigen::MatrixXd g = floating.rows();
      const DenseProblem dense = densify(floating.problem);
      EXPECT_LE(relativeError(g, (dense.constraint * dense.kernel).transpose()), 1e-13);
      const Eigen::VectorXd r = g * g.transpose() * randomVector(g.rows(), 1);
      Eigen::VectorXd weighed(r.size());
      const std::size_t size = r.size();
      floating.space->weigh({r.data(), size}, {weighed.data(), size});
      EXPECT_LE(relativeError(weighed, randomVector(g.rows(), 1)), 1e-12);
      EXPECT_NEAR(floating.space->normOf(r), std::sqrt(r.dot(weighed)), 1e-14 * r.norm());
    }
}

TEST(NaturalCoarseSpaceTest, ProjectorIsSymmetricIdempotentAndRemovesTheRowsOfG) {
  for (const ContactCase& c : floatingCases())
    for (const auto form : {GramInverse::Form::sparse, GramInverse::Form::spread}) {
      SCOPED_TRACE(c.name);
      const Floating floating(c.scene, form);
      const Eigen::MatrixXd p = floating.projector(), g = floating.rows();
      EXPECT_LE((p - p.transpose()).norm(), 1e-14);
      EXPECT_LE((p * p - p).norm(), 1e-14);
      EXPECT_LE((g * p).norm(), 1e-14 * g.norm());
      EXPECT_LE((p * g.transpose()).norm(), 1e-14 * g.norm());
      EXPECT_NEAR(p.trace(), static_cast<double>(p.rows() - g.rows()), 1e-12);
    }
}

TEST(NaturalCoarseSpaceTest, FeasiblePointIsInEquilibriumAndAsShortAsPossible) {
  for (const ContactCase& c : floatingCases()) {
    SCOPED_TRACE(c.name);
    const Floating floating(c.scene);
    const Eigen::VectorXd e = kernelLoad(floating.problem, floating.decomposition.data);
    Vector lambda(floating.map);
    lambda.putScalar(5.0); // what was there does not matter
    floating.space->feasiblePoint(e, lambda);
    EXPECT_LE((floating.space->product(lambda) - e).norm(), 1e-14 * e.norm());
    EXPECT_LE((floating.projector() * gathered(lambda)).norm(), 1e-14 * e.norm()); // λ̃ ⟂ Ker G

    const DenseProblem dense = densify(floating.problem, floating.decomposition.data); // the same as G̃λ̃ = ẽ
    EXPECT_LE(relativeError(dense.kernel.transpose() * dense.constraint.transpose() * gathered(lambda),
                            dense.kernel.transpose() * dense.load),
              1e-13);
  }
}

TEST(NaturalCoarseSpaceTest, ProductAndTransposedProductAreTransposes) {
  const Floating floating(threeMembranes(true, 4, grid(2, 2)));
  const Eigen::Index n = floating.problem.dualDimension();
  const Eigen::VectorXd x = randomVector(n, 1), mu = randomVector(floating.space->size(), 2),
                        y = randomVector(n, 3);
  const RCP<Vector> result = spread(floating.map, y);
  floating.space->addTransposedProduct({mu.data(), 2}, -2.0, *result); // y − 2G̃ᵀμ
  const Eigen::VectorXd gx = floating.space->product(*spread(floating.map, x));
  EXPECT_NEAR(x.dot(gathered(*result) - y), -2.0 * gx.dot(mu), 1e-13 * x.norm() * mu.norm());

  std::vector<AccurateSum> sums(2, AccurateSum(world()->getRank() == 0 ? 1.0 : 0.0));
  floating.space->addLocalProduct(*spread(floating.map, Eigen::VectorXd::Zero(n)),
                                  sums); // adds to what is there
  sumOverRanks(*world(), sums);
  EXPECT_EQ(sums[0].value(), 1.0);
  EXPECT_EQ(sums[1].value(), 1.0);
}

TEST(NaturalCoarseSpaceTest, ABodyThatMeetsNoContactIsRefused) {
  const auto decomposition = decompose(threeMembranes(true, 3, grid(1, 1)), world());
  std::vector<KernelEntry> entries = kernelConstraint(decomposition.problem);
  std::erase_if(entries, [](const KernelEntry& entry) { return entry.mode == 1; });
  EXPECT_THROW(NaturalCoarseSpace(decomposition.problem, entries), Error);
}

TEST(ProjectedOperatorTest, IsTheProjectedDualOperator) {
  for (const ContactCase& c : floatingCases()) {
    SCOPED_TRACE(c.name);
    const Floating floating(c.scene);
    const auto inverse = std::make_shared<GeneralizedInverse>(floating.problem, DirectSolvers());
    const RCP<const Operator> f = rcp(new DualOperator(inverse));
    const ProjectedOperator projected(f, floating.space);
    const Eigen::MatrixXd p = floating.projector();
    EXPECT_LE(relativeError(matrixOf(projected), p * matrixOf(*f) * p), 1e-13);
  }
}

TEST(ProjectedOperatorTest, ScalesAndAddsAsTpetraOperatorsDo) {
  const Floating floating(twoMembranes(false, 4, grid(2, 2)));
  const auto inverse = std::make_shared<GeneralizedInverse>(floating.problem, DirectSolvers());
  const ProjectedOperator projected(rcp(new DualOperator(inverse)), floating.space);
  const Eigen::MatrixXd a = matrixOf(projected);
  const Eigen::VectorXd x = randomVector(a.rows(), 1), y = randomVector(a.rows(), 2);
  const RCP<Vector> input = spread(floating.map, x), output = spread(floating.map, y);
  projected.apply(*input, *output, Teuchos::TRANS, -0.5, 4.0);
  EXPECT_LE(relativeError(gathered(*output), -0.5 * a * x + 4.0 * y), 1e-13);
  EXPECT_LE(relativeError(gathered(*input), x), 0);
}

} // namespace
} // namespace epafi::fetidp
