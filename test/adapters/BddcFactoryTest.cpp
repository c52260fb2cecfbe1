#include "support/LinearSamples.hpp"
#include "support/Refusal.hpp"

#include "epafi/adapters/BddcFactory.hpp"
#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/linear/BddcPreconditioner.hpp"

#include <Thyra_DefaultLinearOpSource.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_PreconditionerFactoryHelpers.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::adapters {
namespace {

using linear::denseOf;

/// M⁻¹ b through a Thyra preconditioner.
Eigen::MatrixXd applied(const Thyra::PreconditionerBase<double>& preconditioner, const RCP<const Vector>& b) {
  const auto op = preconditioner.getUnspecifiedPrecOp();
  const RCP<Vector> x = rcp(new Vector(b->getMap()));
  op->apply(Thyra::NOTRANS, *Thyra::createConstVector<double>(b, op->domain()),
            Thyra::createVector<double>(x, op->range()).ptr(), 1.0, 0.0);
  return denseOf(*x);
}

TEST(BddcFactoryTest, MakesBddcOfAnUnassembledOrAnAssembledOperator) {
  const linear::LinearProblem problem(linear::plate(8, decomposition::grid(2, 2)));
  const RCP<const Vector> b = problem.load();
  Vector expected(b->getMap());
  linear::BddcPreconditioner(problem.k, {}).apply(*b, expected);
  const auto unassembled = adapters::asThyra(problem.k);
  const auto matrix = adapters::asThyra(assembled(*problem.k));

  const BddcFactory alone, informed(problem.k);
  EXPECT_LE(linear::relativeError(applied(*Thyra::prec<double>(alone, unassembled), b), denseOf(expected)),
            1e-14);
  EXPECT_LE(linear::relativeError(applied(*Thyra::prec<double>(informed, matrix), b), denseOf(expected)),
            1e-14);
  EXPECT_LE(linear::relativeError(applied(*Thyra::prec<double>(alone, Thyra::scale(2.0, unassembled)), b),
                                  0.5 * denseOf(expected)),
            1e-14);
  EXPECT_FALSE(alone.isCompatible(*Thyra::defaultLinearOpSource<double>(matrix)));
  test::expectSays(test::refusal([&] { Thyra::prec<double>(alone, matrix); }),
                   {"BDDC knows no decomposition"});
  const linear::LinearProblem other(linear::plate(6, decomposition::grid(2, 2)));
  EXPECT_FALSE(
      informed.isCompatible(*Thyra::defaultLinearOpSource<double>(adapters::asThyra(assembled(*other.k)))));
}

TEST(BddcFactoryTest, WrongParametersAreRefusedByName) {
  BddcFactory factory;
  const auto list = Teuchos::parameterList();
  list->set("Scaling", "by weight");
  test::expectSays(test::refusal([&] { factory.setParameterList(list); }), {"\"Scaling\"", "multiplicity"});
}

} // namespace
} // namespace epafi::adapters
