#include "support/LinearSamples.hpp"

#include "support/Preconditioned.hpp"
#include "support/Refusal.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/linear/BddcPreconditioner.hpp"

#include <BelosBlockCGSolMgr.hpp>
#include <BelosPseudoBlockCGSolMgr.hpp>
#include <BelosTpetraAdapter.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::linear {
namespace {

/// Eigenvalues of M⁻¹K, ascending. Collective.
Eigen::VectorXd spectrumOf(const LinearProblem& problem, const BddcParameters& parameters = {}) {
  const Eigen::MatrixXd k = denseOf(*problem.k), m = denseOf(BddcPreconditioner(problem.k, parameters));
  EXPECT_LE(relativeError(m, m.transpose()), 1e-10);
  const Eigen::MatrixXd lower = direct::choleskyFactor(k).value(),
                        product = lower.transpose() * m * lower; // similar to M⁻¹K
  return direct::eigenOf(0.5 * (product + product.transpose())).values;
}

/// The eigenvalues above 1, ascending.
std::vector<double> aboveOne(const Eigen::VectorXd& eigenvalues) {
  std::vector<double> above;
  for (const double value : eigenvalues)
    if (value > 1 + 1e-6)
      above.push_back(value);
  return above;
}

TEST(BddcPreconditionerTest, HasTheEigenvaluesOfFetiDp) {
  for (const LinearCase& c : linearCases()) {
    SCOPED_TRACE(c.name);
    const LinearProblem problem(c.scene);
    const Eigen::VectorXd bddc = spectrumOf(problem);
    EXPECT_GE(bddc.minCoeff(), 1 - 1e-8);
    EXPECT_LE(bddc.minCoeff(), 1 + 1e-8);
    if (problem.k->problem().dualDimension() == 0) {
      EXPECT_LE(bddc.maxCoeff(), 1 + 1e-8); // M is K
      continue;
    }
    const std::vector<double> ours = aboveOne(bddc),
                              dual = aboveOne(fetidp::spectrum(fetidp::Preconditioned(c.scene)));
    ASSERT_EQ(ours.size(), dual.size());
    ASSERT_FALSE(ours.empty());
    for (std::size_t i = 0; i < ours.size(); ++i)
      EXPECT_NEAR(ours[i], dual[i], 1e-6 * dual[i]);
  }
}

TEST(BddcPreconditionerTest, SharesByMultiplicityWhereStiffnessJumpsAreWorse) {
  const LinearProblem problem(patchwork(8, 1e4));
  BddcParameters equal;
  equal.scaling = fetidp::PreconditionerParameters::Scaling::multiplicity;
  const Eigen::VectorXd byMultiplicity = spectrumOf(problem, equal);
  EXPECT_GE(byMultiplicity.minCoeff(), 1 - 1e-8);
  EXPECT_GT(byMultiplicity.maxCoeff(), 100 * spectrumOf(problem).maxCoeff());
}

using Problem = Belos::LinearProblem<double, MultiVector, Operator>;

/// Belos's CG on the assembled matrix. Collective.
template <template <class, class, class, bool...> class Manager>
int stepsOf(const LinearProblem& problem, const RCP<const Operator>& bddc, bool isLeft,
            const RCP<MultiVector>& x, const RCP<const MultiVector>& b) {
  const RCP<const Operator> k = assembled(*problem.k);
  const RCP<Problem> linear = rcp(new Problem(k, x, b));
  if (isLeft)
    linear->setLeftPrec(bddc);
  else
    linear->setRightPrec(bddc);
  linear->setProblem();
  const auto parameters = Teuchos::parameterList();
  parameters->set("Convergence Tolerance", 1e-10);
  Manager<double, MultiVector, Operator> manager(linear, parameters);
  EXPECT_EQ(manager.solve(), Belos::Converged);
  return manager.getNumIters();
}

TEST(BddcPreconditionerTest, PreconditionsBelosConjugateGradientsFromTheLeftAndFromTheRight) {
  for (const scene::Scene& scene :
       {plate(16, decomposition::grid(4, 4)), elasticBlock(8, 0, test::cutByMetis(4))}) {
    const LinearProblem problem(scene);
    const RCP<const Operator> bddc = rcp(new BddcPreconditioner(problem.k, {}));
    const Eigen::MatrixXd loads = denseOf(*problem.load()), k = denseOf(*problem.k);
    Eigen::MatrixXd two(loads.rows(), 2);
    two << loads, Eigen::VectorXd::LinSpaced(loads.rows(), -1, 1);
    const RCP<const MultiVector> b = spreadOn(problem.k->getRangeMap(), two);
    const Eigen::MatrixXd expected = direct::inverseOfSpd(k) * two;
    for (const bool isLeft : {true, false}) {
      const RCP<MultiVector> x = rcp(new MultiVector(b->getMap(), 2));
      EXPECT_LE(stepsOf<Belos::PseudoBlockCGSolMgr>(problem, bddc, isLeft, x, b), 20);
      EXPECT_LE(relativeError(denseOf(*x), expected), 1e-8);
    }
  }
}

/// Steps do not depend on the number of ranks: the condition number does not.
TEST(BddcPreconditionerTest, TheNumberOfRanksDoesNotMatter) {
  const scene::Scene scene = plate(12, decomposition::grid(3, 3));
  const LinearProblem all(scene), alone(scene, fetidp::thisRankOnly());
  const Eigen::MatrixXd here = denseOf(BddcPreconditioner(all.k, {})),
                        there = denseOf(BddcPreconditioner(alone.k, {}));
  EXPECT_LE(relativeError(here, there), 1e-13);
}

TEST(BddcPreconditionerTest, RefusesWhatFetiDpRefuses) {
  const LinearProblem contact(decomposition::twoMembranes(true, 4, decomposition::grid(2, 2)));
  test::expectSays(test::refusal([&] { BddcPreconditioner(contact.k, {}); }),
                   {"BDDC solves linear problems"});
  const LinearProblem floating(decomposition::oneBody(4, 4, decomposition::grid(2, 2), {}));
  EXPECT_THROW(BddcPreconditioner(floating.k, {}), SolvabilityError);
  Teuchos::ParameterList list;
  list.set("Scaling", "stifness");
  test::expectSays(test::refusal([&] { validated(list, BddcParameters::validParameters(), ""); }),
                   {"\"Scaling\"", "did you mean \"stiffness\"?"});
}

} // namespace
} // namespace epafi::linear
