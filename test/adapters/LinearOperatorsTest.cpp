#include "support/LinearSamples.hpp"

#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/fetidp/equilibrium/Projector.hpp"
#include "epafi/linear/BddcPreconditioner.hpp"
#include "epafi/linear/PartiallyAssembledInverse.hpp"

#include <Teuchos_FancyOStream.hpp>
#include <Thyra_LinearOpTester.hpp>
#include <gtest/gtest.h>

#include <sstream>

namespace epafi::adapters {
namespace {

/// Thyra's own checks with random vectors: linear in both ways of multiplying, equal adjoint, symmetric.
void expectSymmetricOperator(const RCP<const Operator>& a) {
  const auto op = adapters::asThyra(a);
  Thyra::LinearOpTester<double> tester;
  tester.check_adjoint(true);
  tester.check_for_symmetry(true);
  tester.set_all_error_tol(1e-8);
  tester.set_all_warning_tol(1e-6);
  std::ostringstream log;
  EXPECT_TRUE(tester.check(*op, Teuchos::getFancyOStream(Teuchos::rcpFromRef(log)).ptr())) << log.str();
}

/// F, its preconditioner, P, PFP and K̄⁺ of a contact problem.
void expectSymmetricOperators(const scene::Scene& scene) {
  const auto cut = std::make_shared<linear::Decomposition>(model::decompose(scene, fetidp::world()));
  const std::shared_ptr<const decomposition::DecomposedProblem> problem(cut, &cut->problem);
  ContactSolver solver{Teuchos::ParameterList()};
  solver.setup(*problem, cut->data);
  const fetidp::DualProblem& dual = solver.dualProblem();
  {
    SCOPED_TRACE("F");
    expectSymmetricOperator(dual.dualOperator());
  }
  {
    SCOPED_TRACE("PFP");
    expectSymmetricOperator(dual.hessian());
  }
  {
    SCOPED_TRACE("preconditioner");
    expectSymmetricOperator(dual.preconditioner());
  }
  if (!dual.coarseSpace().is_null()) {
    SCOPED_TRACE("P");
    expectSymmetricOperator(rcp(new fetidp::Projector(problem->multiplierMap, dual.coarseSpace())));
  }
  SCOPED_TRACE("generalised inverse");
  const auto inverse = std::make_shared<fetidp::GeneralizedInverse>(*problem, fetidp::DirectSolvers());
  expectSymmetricOperator(rcp(new linear::PartiallyAssembledInverse(*problem, inverse)));
}

TEST(LinearOperatorsTest, ThoseOfContactProblemsAreSymmetricThroughThyra) {
  expectSymmetricOperators(decomposition::twoMembranes(true, 6, decomposition::grid(2, 2)));
  expectSymmetricOperators(decomposition::twoMembranes(false, 6, decomposition::metis(3)));
}

TEST(LinearOperatorsTest, KAndBddcAreSymmetricThroughThyra) {
  for (const linear::LinearCase& c : linear::linearCases()) {
    SCOPED_TRACE(c.name);
    const linear::LinearProblem problem(c.scene);
    expectSymmetricOperator(problem.k);
    expectSymmetricOperator(rcp(new linear::BddcPreconditioner(problem.k, {})));
  }
}

TEST(LinearOperatorsTest, TheProjectorLeavesWhatIsInEquilibrium) {
  const auto cut =
      model::decompose(decomposition::twoMembranes(false, 4, decomposition::grid(2, 2)), fetidp::world());
  const auto space = rcp(new fetidp::NaturalCoarseSpace(cut.problem, fetidp::kernelConstraint(cut.problem)));
  const Eigen::MatrixXd p = linear::denseOf(fetidp::Projector(cut.problem.multiplierMap, space));
  EXPECT_LE(linear::relativeError(p * p, p), 1e-13);
  EXPECT_NEAR(p.trace(), static_cast<double>(p.rows() - 1), 1e-12); // one body floats, with one mode
}

} // namespace
} // namespace epafi::adapters
