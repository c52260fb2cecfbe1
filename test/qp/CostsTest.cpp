/// What a step costs beside its product: messages and allocations, counted by taking the place of
/// MPI_Allreduce and of operator new.

#include "CountingAllocator.hpp"
#include "support/Problems.hpp"

#include "epafi/base/Columns.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/constraints/PenalizedOperator.hpp"
#include "epafi/qp/solve/Mprgp.hpp"

#include <gtest/gtest.h>
#include <mpi.h>

#include <array>
#include <limits>

namespace {

int numReductions = 0;

} // namespace

extern "C" int MPI_Allreduce(const void* sendbuf, void* recvbuf, int count, MPI_Datatype datatype, MPI_Op op,
                             MPI_Comm comm) {
  ++numReductions;
  return PMPI_Allreduce(sendbuf, recvbuf, count, datatype, op, comm);
}

namespace {

using namespace epafi;

/// A diagonal operator that neither sends a message nor allocates.
class Diagonal final : public Operator {
public:
  explicit Diagonal(RCP<const Vector> diagonal) : diagonal_(std::move(diagonal)) {}
  RCP<const Map> getDomainMap() const override { return diagonal_->getMap(); }
  RCP<const Map> getRangeMap() const override { return diagonal_->getMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double, double) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      const auto values = qp::localData(in), diagonal = qp::localData(*diagonal_);
      const auto result = qp::localDataNonConst(out);
      for (std::size_t i = 0; i < values.size(); ++i)
        result[i] = diagonal[i] * values[i];
    });
  }

private:
  RCP<const Vector> diagonal_;
};

struct Costs {
  double reductions, allocations; ///< a step
  int steps;
};

/// Costs of one step, from the difference between a short and a long run.
Costs costsOfAStep(const RCP<const Operator>& a, const RCP<const qp::ConvexSet>& set,
                   const RCP<const Vector>& b, const RCP<const Operator>& preconditioner,
                   qp::MprgpParameters parameters) {
  std::array<double, 2> reductions{}, allocations{};
  std::array<int, 2> steps{};
  for (const int run : {0, 0, 1}) { // the first one makes the work space
    parameters.maxMultiplications = run == 0 ? 4 : 14;
    qp::Mprgp solver(a, set, parameters, 1.0, preconditioner);
    solver.start(*b, Vector(b->getMap()));
    qp::GradientRule rule(1e-15, 1.0);
    numReductions = 0;
    const long before = test::numAllocations();
    solver.run(rule, nullptr);
    const std::size_t i = run;
    reductions[i] = numReductions;
    allocations[i] = static_cast<double>(test::numAllocations() - before);
    steps[i] = solver.counts().conjugateGradient + solver.counts().expansion + solver.counts().proportioning;
  }
  const int more = steps[1] - steps[0];
  return {(reductions[1] - reductions[0]) / more, (allocations[1] - allocations[0]) / more, more};
}

class CostsTest : public testing::Test {
protected:
  RCP<const Map> map = test::linearMap(60);
  RCP<const Vector> diagonal = test::makeVector(map, [](int i) { return std::pow(0.9, i); });
  RCP<const Operator> a = rcp(new Diagonal(diagonal));
  RCP<const Vector> b = test::makeVector(map, [](int i) { return 1.0 + 0.1 * i; });
  RCP<const qp::ConvexSet> far =
      rcp(new qp::Box(test::makeVector(map, [](int) { return -std::numeric_limits<double>::infinity(); })));
  const bool isAlone = map->getComm()->getSize() == 1; // no messages then
};

TEST_F(CostsTest, ACgStepMakesTwoReductionsAndNoAllocation) {
  const Costs costs = costsOfAStep(a, far, b, Teuchos::null, {});

  ASSERT_GT(costs.steps, 5);
  EXPECT_EQ(costs.reductions, isAlone ? 0 : 2);
  EXPECT_EQ(costs.allocations, 0);
}

TEST_F(CostsTest, APreconditionedCgStepMakesTwoReductionsAndNoAllocationEither) {
  const RCP<const Vector> inverse = test::makeVector(map, [](int i) { return std::pow(0.95, -i); });

  const Costs costs = costsOfAStep(a, far, b, rcp(new Diagonal(inverse)), {});

  ASSERT_GT(costs.steps, 5);
  EXPECT_EQ(costs.reductions, isAlone ? 0 : 2);
  EXPECT_EQ(costs.allocations, 0);
}

TEST_F(CostsTest, NoKindOfStepAllocates) {
  const RCP<const qp::ConvexSet> near =
      rcp(new qp::Box(test::makeVector(map, [](int i) { return -1.0 - i % 5; }),
                      test::makeVector(map, [](int i) { return 3.0 + i % 7; })));
  for (const auto expansion : {qp::Expansion::fixedStep, qp::Expansion::projectedCg}) {
    qp::MprgpParameters parameters;
    parameters.expansion = expansion;

    const Costs costs = costsOfAStep(a, near, b, Teuchos::null, parameters);

    EXPECT_GT(costs.steps, 2);
    EXPECT_EQ(costs.allocations, 0);
  }
}

TEST_F(CostsTest, TheAugmentedLagrangianCostsOneMessageMoreAProduct) {
  const RCP<const qp::EqualityConstraint> rows =
      rcp(new test::DenseEquality(map, Eigen::MatrixXd::Constant(1, 60, 1 / std::sqrt(60.0))));
  const RCP<const Operator> hessian = rcp(new qp::PenalizedOperator(a, map, rows, 1.0));

  const Costs costs = costsOfAStep(hessian, far, b, Teuchos::null, {});

  EXPECT_EQ(costs.reductions, isAlone ? 0 : 3);
  EXPECT_EQ(costs.allocations, 0);
}

} // namespace
