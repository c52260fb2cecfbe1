#include "support/DenseProblem.hpp"

#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"
#include "epafi/fetidp/equilibrium/ProjectedOperator.hpp"
#include "epafi/fetidp/operator/DualOperator.hpp"

#include <Thyra_LinearOpBase.hpp>
#include <Thyra_MultiVectorBase.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

/// Three random columns, the same on any number of ranks.
RCP<MultiVector> randomColumns(const RCP<const Map>& map, unsigned seed) {
  const RCP<MultiVector> columns = rcp(new MultiVector(map, 3));
  for (unsigned j = 0; j < 3; ++j)
    columns->getVectorNonConst(j)->assign(
        *spread(map, randomVector(static_cast<Eigen::Index>(map->getGlobalNumElements()), seed + j)));
  return columns;
}

void expectSameProducts(const RCP<const Operator>& a) {
  const auto thyra = adapters::asThyra(a);
  ASSERT_EQ(thyra->range()->dim(), static_cast<Teuchos_Ordinal>(a->getRangeMap()->getGlobalNumElements()));
  ASSERT_EQ(thyra->domain()->dim(), thyra->range()->dim());
  for (const auto& [mode, transposed] :
       {std::pair(Thyra::NOTRANS, Teuchos::NO_TRANS), std::pair(Thyra::TRANS, Teuchos::TRANS)})
    for (const auto& [alpha, beta] : {std::pair(1.0, 0.0), std::pair(-2.0, 0.5), std::pair(0.0, 3.0)}) {
      SCOPED_TRACE(testing::Message() << "mode " << mode << ", alpha " << alpha << ", beta " << beta);
      ASSERT_TRUE(thyra->opSupported(mode));
      const RCP<const MultiVector> x = randomColumns(a->getDomainMap(), 10);
      const RCP<MultiVector> y = randomColumns(a->getRangeMap(), 20),
                             expected = randomColumns(a->getRangeMap(), 20);
      thyra->apply(mode, *Thyra::createConstMultiVector<double>(x, thyra->domain()),
                   Thyra::createMultiVector<double>(y, thyra->range()).ptr(), alpha, beta);
      a->apply(*x, *expected, transposed, alpha, beta);
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_LE(relativeError(gathered(*y->getVector(j)), gathered(*expected->getVector(j))), 1e-14);
    }
}

TEST(ThyraOperatorsTest, TheDualOperatorIsTheSameThroughThyra) {
  for (const auto& cut : {grid(1, 1), grid(2, 2)}) {
    const auto decomposition = decompose(twoMembranes(true, 4, cut), world());
    const auto inverse = std::make_shared<GeneralizedInverse>(decomposition.problem, DirectSolvers());
    expectSameProducts(rcp(new DualOperator(inverse)));
  }
}

TEST(ThyraOperatorsTest, TheProjectedOperatorIsTheSameThroughThyra) {
  const auto decomposition = decompose(twoMembranes(false, 4, grid(2, 2)), world());
  const DecomposedProblem& problem = decomposition.problem;
  const auto inverse = std::make_shared<GeneralizedInverse>(problem, DirectSolvers());
  expectSameProducts(rcp(new ProjectedOperator(
      rcp(new DualOperator(inverse)), rcp(new NaturalCoarseSpace(problem, kernelConstraint(problem))))));
}

} // namespace
} // namespace epafi::fetidp
