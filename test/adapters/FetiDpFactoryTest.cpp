#include "support/LinearSamples.hpp"
#include "support/Refusal.hpp"

#include "epafi/adapters/FetiDpFactory.hpp"
#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Thyra_DefaultLinearOpSource.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_LinearOpWithSolveBase.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_MultiVectorStdOps.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::adapters {
namespace {

using linear::denseOf;
using linear::LinearProblem;
using linear::plate;
using linear::relativeError;
using linear::spreadOn;
using MultiVectors = RCP<Thyra::MultiVectorBase<double>>;
using Operators = RCP<const Thyra::LinearOpBase<double>>;

/// K of a plate as Thyra sees it, two right-hand sides and what they ask for.
struct Sample {
  LinearProblem problem{plate(12, decomposition::grid(3, 3))};
  Operators k = adapters::asThyra(problem.k);
  Eigen::MatrixXd dense = denseOf(*problem.k);
  Eigen::MatrixXd loads{dense.rows(), 2};
  RCP<MultiVector> b, x;

  Sample() {
    loads << denseOf(*problem.load()), Eigen::VectorXd::LinSpaced(dense.rows(), -1, 1);
    b = spreadOn(problem.k->getRangeMap(), loads);
    x = rcp(new MultiVector(problem.k->getDomainMap(), 2));
  }
  Thyra::SolveStatus<double>
  solve(const Thyra::LinearOpWithSolveBase<double>& op,
        const Teuchos::Ptr<const Thyra::SolveCriteria<double>>& criteria = Teuchos::null,
        Thyra::EOpTransp mode = Thyra::NOTRANS) const {
    return op.solve(mode, *Thyra::createMultiVector<double>(b, k->range()),
                    Thyra::createMultiVector<double>(x, k->domain()).ptr(), criteria);
  }
  [[nodiscard]] double residual(double factor = 1) const {
    return ((loads - factor * dense * denseOf(*x)).colwise().norm().array() / loads.colwise().norm().array())
        .maxCoeff();
  }
};

TEST(FetiDpFactoryTest, SolvesAndReportsTheResidual) {
  Sample sample;
  const FetiDpFactory factory;
  const auto op = Thyra::linearOpWithSolve<double>(factory, sample.k);
  EXPECT_TRUE(op->range()->isCompatible(*sample.k->range()));
  const auto status = sample.solve(*op);
  EXPECT_EQ(status.solveStatus, Thyra::SOLVE_STATUS_CONVERGED) << status.message;
  EXPECT_LE(status.achievedTol, 1e-8);
  EXPECT_NEAR(status.achievedTol, sample.residual(), 1e-12);
  EXPECT_GT(status.extraParameters->get<int>("Iteration Count"), 0);
  EXPECT_LE(relativeError(denseOf(*sample.x), direct::solvedSymmetric(sample.dense, sample.loads)), 1e-6);
}

TEST(FetiDpFactoryTest, ProductsAreThoseOfK) {
  Sample sample;
  const auto op = Thyra::linearOpWithSolve<double>(FetiDpFactory(), sample.k);
  const MultiVectors y = Thyra::createMultiVector<double>(sample.x, sample.k->range());
  op->apply(Thyra::TRANS, *Thyra::createMultiVector<double>(sample.b, sample.k->domain()), y.ptr(), 2.0, 0.0);
  EXPECT_LE(relativeError(denseOf(*sample.x), 2 * sample.dense * sample.loads), 1e-13);
}

TEST(FetiDpFactoryTest, HonoursTheCriteriaAskedFor) {
  Sample sample;
  const auto op = Thyra::linearOpWithSolve<double>(FetiDpFactory(), sample.k);
  using Measure = Thyra::SolveMeasureType;
  const Measure byRhs(Thyra::SOLVE_MEASURE_NORM_RESIDUAL, Thyra::SOLVE_MEASURE_NORM_RHS),
      byStart(Thyra::SOLVE_MEASURE_NORM_RESIDUAL, Thyra::SOLVE_MEASURE_NORM_INIT_RESIDUAL),
      bySolution(Thyra::SOLVE_MEASURE_NORM_SOLUTION, Thyra::SOLVE_MEASURE_ONE);
  const Thyra::SolveCriteria<double> coarse(byRhs, 1e-3), fine(byRhs, 1e-11), further(byStart, 1e-2),
      strange(bySolution, 1e-3);
  const auto first = sample.solve(*op, Teuchos::ptr(&coarse));
  EXPECT_LE(first.achievedTol, 1e-3);
  EXPECT_GT(first.achievedTol, 1e-8);
  const double before = sample.residual();
  const auto second = sample.solve(*op, Teuchos::ptr(&further), Thyra::TRANS); // goes on from there
  EXPECT_LE(second.achievedTol, 1e-2);
  EXPECT_LE(sample.residual(), 0.02 * before);
  EXPECT_LE(sample.solve(*op, Teuchos::ptr(&fine), Thyra::CONJTRANS).achievedTol, 1e-11);
  EXPECT_TRUE(op->solveSupportsSolveMeasureType(Thyra::NOTRANS, byStart));
  EXPECT_FALSE(op->solveSupportsSolveMeasureType(Thyra::NOTRANS, bySolution));
  test::expectSays(test::refusal([&] { sample.solve(*op, Teuchos::ptr(&strange)); }),
                   {"cannot stop by the measure"});
}

TEST(FetiDpFactoryTest, AnUnreachedToleranceIsReported) {
  Sample sample;
  FetiDpFactory factory;
  const auto list = Teuchos::parameterList();
  list->set("Maximum Iterations", 1);
  factory.setParameterList(list);
  const auto status = sample.solve(*Thyra::linearOpWithSolve<double>(factory, sample.k));
  EXPECT_EQ(status.solveStatus, Thyra::SOLVE_STATUS_UNCONVERGED);
  EXPECT_NEAR(status.achievedTol, sample.residual(), 1e-12);
  EXPECT_NE(status.message.find("Maximum Iterations"), std::string::npos) << status.message;
}

TEST(FetiDpFactoryTest, LooksThroughFactorsAndTransposes) {
  Sample sample;
  const Operators scaled = Thyra::scale(-4.0, Thyra::adjoint(sample.k));
  const FetiDpFactory factory;
  EXPECT_TRUE(factory.isCompatible(*Thyra::defaultLinearOpSource<double>(scaled)));
  const auto op = Thyra::linearOpWithSolve<double>(factory, scaled);
  EXPECT_EQ(sample.solve(*op).solveStatus, Thyra::SOLVE_STATUS_CONVERGED);
  EXPECT_LE(sample.residual(-4.0), 1.001e-8);
}

TEST(FetiDpFactoryTest, SaysNoToOtherOperators) {
  const Sample sample;
  const FetiDpFactory factory;
  EXPECT_TRUE(factory.isCompatible(*Thyra::defaultLinearOpSource<double>(sample.k)));
  const RCP<const Operator> matrix = assembled(*sample.problem.k);
  const Operators other = adapters::asThyra(matrix);
  EXPECT_FALSE(factory.isCompatible(*Thyra::defaultLinearOpSource<double>(other)));
  test::expectSays(test::refusal([&] { Thyra::linearOpWithSolve<double>(factory, other); }),
                   {"FETI-DP cannot solve with the operator", "UnassembledOperator"});
}

TEST(FetiDpFactoryTest, AnOperatorCanBeInitialisedAgainAndOutlivesItsFactory) {
  Sample sample;
  const LinearProblem stiffer(linear::patchwork(12, 1e3));
  RCP<Thyra::LinearOpWithSolveBase<double>> op;
  RCP<const Thyra::LinearOpSourceBase<double>> given;
  {
    const FetiDpFactory factory;
    op = factory.createOp();
    EXPECT_TRUE(op->range().is_null());
    Thyra::initializeOp<double>(factory, adapters::asThyra(stiffer.k), op.ptr());
    factory.uninitializeOp(&*op, &given, nullptr, nullptr, nullptr);
    EXPECT_EQ(given->getOp()->domain()->dim(),
              static_cast<Teuchos_Ordinal>(stiffer.k->getDomainMap()->getGlobalNumElements()));
    EXPECT_TRUE(op->range().is_null());
    Thyra::initializeOp<double>(factory, sample.k, op.ptr());
  }
  EXPECT_EQ(sample.solve(*op).solveStatus, Thyra::SOLVE_STATUS_CONVERGED);
  EXPECT_LE(sample.residual(), 1.001e-8);
}

TEST(FetiDpFactoryTest, InitialisedAgainItFollowsTheMatrices) {
  Sample sample;
  const FetiDpFactory factory;
  const auto op = Thyra::linearOpWithSolve<double>(factory, sample.k);
  sample.solve(*op);
  const auto* const solver = dynamic_cast<const FetiDpSolve&>(*op).solver().get();
  for (decomposition::Subdomain& subdomain : sample.problem.decomposition->problem.subdomains)
    decomposition::changeStiffness(subdomain, [](decomposition::SparseMatrix& k) { k *= 3; });
  Thyra::initializeOp<double>(factory, sample.k, op.ptr());
  EXPECT_EQ(dynamic_cast<const FetiDpSolve&>(*op).solver().get(), solver); // what holds is kept
  EXPECT_EQ(sample.solve(*op).solveStatus, Thyra::SOLVE_STATUS_CONVERGED);
  EXPECT_LE(sample.residual(3.0), 1.001e-8);
}

TEST(FetiDpFactoryTest, WrongParametersAreRefusedByName) {
  FetiDpFactory factory;
  const auto list = Teuchos::parameterList();
  list->set("Tolerence", 1e-3);
  test::expectSays(test::refusal([&] { factory.setParameterList(list); }),
                   {"Tolerence", "did you mean \"Tolerance\"?"});
  test::expectSays(test::refusal([&] { factory.setParameterList(Teuchos::null); }), {"no parameter list"});
}

} // namespace
} // namespace epafi::adapters
