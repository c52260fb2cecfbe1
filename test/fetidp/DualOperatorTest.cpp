#include "support/DenseProblem.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/operator/DualOperator.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace epafi::fetidp {
namespace {

/// F and what it is made of.
struct Assembled {
  explicit Assembled(const scene::Scene& scene)
      : decomposition(decompose(scene, world())),
        inverse(std::make_shared<GeneralizedInverse>(decomposition.problem, DirectSolvers())), op(inverse) {}

  model::Decomposition decomposition;
  std::shared_ptr<GeneralizedInverse> inverse;
  DualOperator op;
};

/// P of the dense G̃ = RᵀB̄ᵀ.
Eigen::MatrixXd projector(const DenseProblem& dense) {
  const Eigen::MatrixXd gt = dense.constraint * dense.kernel;
  return Eigen::MatrixXd::Identity(gt.rows(), gt.rows()) -
         gt * pseudoInverse(gt.transpose() * gt) * gt.transpose();
}

TEST(DualOperatorTest, IsSymmetric) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Eigen::MatrixXd f = matrixOf(Assembled(c.scene).op);
    ASSERT_GT(f.norm(), 0);
    EXPECT_LE((f - f.transpose()).norm(), 1e-12 * f.norm());
  }
}

TEST(DualOperatorTest, IsPositiveDefiniteWhereNoBodyFloats) {
  for (const ContactCase& c : contactCases()) {
    if (!c.coercive)
      continue;
    SCOPED_TRACE(c.name);
    const Eigen::VectorXd spectrum = direct::eigenOf(matrixOf(Assembled(c.scene).op)).values;
    EXPECT_GT(spectrum.minCoeff(), 1e-3 * spectrum.maxCoeff());
  }
}

TEST(DualOperatorTest, IsPositiveDefiniteOnTheKernelOfGAndNowhereElseNeeded) {
  for (const ContactCase& c : contactCases()) {
    if (c.coercive)
      continue;
    SCOPED_TRACE(c.name);
    const Assembled assembled(c.scene);
    const Eigen::MatrixXd p = projector(densify(assembled.decomposition.problem));
    const Eigen::MatrixXd pfp = p * matrixOf(assembled.op) * p;
    const Eigen::VectorXd spectrum = direct::eigenOf(0.5 * (pfp + pfp.transpose())).values;
    const double largest = spectrum.maxCoeff();
    const int k = assembled.decomposition.problem.kernelDimension;
    ASSERT_GT(k, 0);
    EXPECT_LE(spectrum.head(k).cwiseAbs().maxCoeff(), 1e-12 * largest); // Im Gᵀ
    EXPECT_GT(spectrum[k], 1e-4 * largest);
  }
}

TEST(DualOperatorTest, EqualsTheUndecomposedComputation) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const Assembled assembled(c.scene);
    const DenseProblem dense = densify(assembled.decomposition.problem);
    const Eigen::MatrixXd expected =
        dense.constraint * pseudoInverse(dense.stiffness) * dense.constraint.transpose();
    // Generalised inverses differ by the rigid modes, which P removes.
    const Eigen::MatrixXd p = projector(dense);
    EXPECT_LE(relativeError(p * matrixOf(assembled.op) * p, p * expected * p), 1e-11);
  }
}

TEST(DualOperatorTest, GluesABodyWithoutContact) {
  const Assembled assembled(decomposition::oneBody(4, 4, metis(4), {{"wall", "left", {0.0}}}));
  const DenseProblem dense = densify(assembled.decomposition.problem);
  ASSERT_GT(dense.constraint.rows(), 0);
  const Eigen::MatrixXd expected =
      dense.constraint * pseudoInverse(dense.stiffness) * dense.constraint.transpose();
  EXPECT_LE(relativeError(matrixOf(assembled.op), expected), 1e-12);
}

TEST(DualOperatorTest, HasNoRowsWhereNothingIsGlued) {
  const Assembled assembled(decomposition::oneBody(3, 3, grid(1, 1), {{"wall", "left", {0.0}}}));
  EXPECT_EQ(assembled.op.getDomainMap()->getGlobalNumElements(), 0u);
  const Vector x(assembled.op.getDomainMap());
  Vector y(assembled.op.getRangeMap());
  assembled.op.apply(x, y);
  EXPECT_EQ(y.norm2(), 0);
}

TEST(DualOperatorTest, ScalesAndAddsAsTpetraOperatorsDo) {
  const Assembled assembled(twoMembranes(true, 4, grid(2, 2)));
  const Eigen::MatrixXd f = matrixOf(assembled.op);
  const Eigen::VectorXd x = randomVector(f.rows(), 1), y = randomVector(f.rows(), 2);
  const RCP<const Map> map = assembled.op.getDomainMap();
  const RCP<Vector> input = spread(map, x), output = spread(map, y);

  assembled.op.apply(*input, *output, Teuchos::NO_TRANS, 2.0, -3.0);
  EXPECT_LE(relativeError(gathered(*output), 2.0 * f * x - 3.0 * y), 1e-13);
  output->putScalar(std::numeric_limits<double>::quiet_NaN());
  assembled.op.apply(*input, *output, Teuchos::TRANS, 1.0, 0.0); // beta = 0 forgets what was there
  EXPECT_LE(relativeError(gathered(*output), f * x), 1e-13);
  EXPECT_LE(relativeError(gathered(*input), x), 0);
}

TEST(DualOperatorTest, HalvesOfTwoProductsMayAlternate) {
  const Assembled assembled(twoMembranes(true, 4, grid(2, 2)));
  const GeneralizedInverse& inverse = *assembled.inverse;
  const std::size_t numMultipliers = numLocal(*assembled.decomposition.problem.multiplierGhostMap);
  const std::vector<double> one(numMultipliers, 1.0), two(numMultipliers, 2.0);
  std::vector<AccurateSum> coarse(inverse.coarseProblem().size());
  const Eigen::MatrixXd held = Eigen::MatrixXd::Zero(inverse.coarseProblem().size(), 1);
  for (const SubdomainGroup& group : inverse.groups()) {
    SubdomainGroup::Workspace first, second;
    std::vector<double> ofOne(numMultipliers, 0.0), ofTwo(numMultipliers, 0.0);
    group.applyFlexibility(one, coarse, 1, first);
    group.applyFlexibility(two, coarse, 1, second);
    group.applyCoupling(held, ofOne, first);
    group.applyCoupling(held, ofTwo, second);
    for (std::size_t i = 0; i < numMultipliers; ++i)
      EXPECT_NEAR(ofTwo[i], 2 * ofOne[i], 1e-14);
  }
}

} // namespace
} // namespace epafi::fetidp
