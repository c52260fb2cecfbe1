#include "support/LinearSamples.hpp"

#include "epafi/fetidp/operator/DualOperator.hpp"
#include "epafi/linear/PartiallyAssembledInverse.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::linear {
namespace {

/// Held and floating bodies, in contact or not.
TEST(PartiallyAssembledInverseTest, IsAGeneralisedInverseOfWhichFIsMade) {
  std::vector<LinearCase> cases = linearCases();
  for (const fetidp::ContactCase& c : fetidp::contactCases())
    cases.push_back({c.name, c.scene});
  for (const LinearCase& c : cases) {
    SCOPED_TRACE(c.name);
    const auto cut = std::make_shared<Decomposition>(model::decompose(c.scene, world()));
    const std::shared_ptr<const decomposition::DecomposedProblem> problem(cut, &cut->problem);
    const auto inverse = std::make_shared<fetidp::GeneralizedInverse>(*problem, fetidp::DirectSolvers());
    const Eigen::MatrixXd plus = denseOf(PartiallyAssembledInverse(*problem, inverse));
    const Eigen::MatrixXd k = decomposition::mergedStiffness(*problem),
                          b = decomposition::mergedConstraint(*problem);
    EXPECT_LE(relativeError(k * plus * k, k), 1e-9);
    EXPECT_LE(relativeError(plus, plus.transpose()), 1e-9);
    if (problem->dualDimension() > 0) {
      const Eigen::MatrixXd f = denseOf(fetidp::DualOperator(inverse));
      EXPECT_LE(relativeError(b * plus * b.transpose(), f), 1e-9);
    }
  }
}

} // namespace
} // namespace epafi::linear
