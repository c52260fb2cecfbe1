#include "support/DenseProblem.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/operator/DualOperator.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

namespace epafi::fetidp {
namespace {

/// K̄⁺ as a matrix over merged unknowns. Collective.
Eigen::MatrixXd inverseMatrix(const DecomposedProblem& problem, GeneralizedInverse& inverse) {
  const Eigen::Index n = decomposition::mergedSize(problem);
  Eigen::MatrixXd matrix(n, n);
  SubdomainVectors u;
  for (Eigen::Index j = 0; j < n; ++j) {
    inverse.apply(forcesOf(problem, Eigen::VectorXd::Unit(n, j)), u);
    matrix.col(j) = mergeValues(problem, u);
  }
  return matrix;
}

TEST(GeneralizedInverseTest, InvertsOnTheRangeOfTheStiffness) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    GeneralizedInverse inverse(decomposition.problem, DirectSolvers());
    const Eigen::MatrixXd k = densify(decomposition.problem).stiffness;
    const Eigen::MatrixXd plus = inverseMatrix(decomposition.problem, inverse);
    EXPECT_LE(relativeError(k * plus * k, k), 1e-12); // K̄ K̄⁺ K̄ = K̄
    if (decomposition.problem.kernelDimension == 0) {
      EXPECT_LE(relativeError(k * plus, Eigen::MatrixXd::Identity(k.rows(), k.rows())), 1e-12);
    }
  }
}

TEST(GeneralizedInverseTest, TakesSeveralLoadsAtOnce) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    const DecomposedProblem& problem = decomposition.problem;
    GeneralizedInverse inverse(problem, DirectSolvers());
    constexpr int numLoads = 5; // more than are solved for at once
    SubdomainVectors loads(problem.subdomains.size()), together, single;
    for (std::size_t s = 0; s < loads.size(); ++s)
      loads[s].resize(problem.subdomains[s].stiffness->rows(), numLoads);
    const auto loadOf = [&](int j) {
      return forcesOf(problem,
                      randomVector(decomposition::mergedSize(problem), 7 + static_cast<unsigned>(j)));
    };
    for (int j = 0; j < numLoads; ++j) {
      const SubdomainVectors load = loadOf(j);
      for (std::size_t s = 0; s < loads.size(); ++s)
        loads[s].col(j) = load[s];
    }
    GeneralizedInverse::Workspace work;
    inverse.apply(loads, together, numLoads, work);
    for (int j = 0; j < numLoads; ++j) {
      inverse.apply(loadOf(j), single);
      for (std::size_t s = 0; s < single.size(); ++s)
        EXPECT_LE((together[s].col(j) - single[s]).norm(), 1e-13 * single[s].norm());
    }
  }
}

TEST(GeneralizedInverseTest, FindsRemaindersOfGivenCrosspointsAfterAnyUse) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    const DecomposedProblem& problem = decomposition.problem;
    GeneralizedInverse inverse(problem, DirectSolvers());
    const SubdomainVectors load = forcesOf(problem, randomVector(decomposition::mergedSize(problem), 11));
    SubdomainVectors expected, u;
    inverse.apply(load, expected);
    constexpr int numColumns = 9;
    const auto numRows = numColumns * numLocal(*problem.multiplierGhostMap);
    std::vector<double> lambda(numRows, 1.0), result(numRows);
    GeneralizedInverse::Workspace work;
    inverse.applyDual(lambda, result, numColumns, work);
    u = expected;
    for (std::size_t s = 0; s < u.size(); ++s)
      for (const int unknown : problem.subdomains[s].remainderUnknowns)
        u[s](unknown, 0) = 0;
    inverse.solveRemainders(load, u, 1, work);
    ASSERT_EQ(u.size(), expected.size());
    for (std::size_t s = 0; s < u.size(); ++s) {
      ASSERT_EQ(u[s].cols(), 1);
      EXPECT_LE((u[s] - expected[s]).norm(), 1e-12 * expected[s].norm());
    }
  }
}

TEST(GeneralizedInverseTest, WhoSharesAnEarlierOneKeepsItValid) {
  auto decomposition = decompose(twoMembranes(true, 8, grid(2, 2)), world());
  auto inverse = std::make_shared<GeneralizedInverse>(decomposition.problem, DirectSolvers());
  const DualOperator earlier(inverse);
  const Eigen::MatrixXd f = matrixOf(earlier);
  for (auto& subdomain : decomposition.problem.subdomains)
    if (subdomain.number == 0)
      subdomain.stiffness = std::make_shared<const decomposition::SparseMatrix>(2.0 * *subdomain.stiffness);
  inverse = std::make_shared<GeneralizedInverse>(decomposition.problem, DirectSolvers(), std::move(inverse));
  EXPECT_EQ(relativeError(matrixOf(earlier), f), 0);
  EXPECT_GT(relativeError(matrixOf(DualOperator(inverse)), f), 1e-3);
}

TEST(GeneralizedInverseTest, IsSymmetric) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    GeneralizedInverse inverse(decomposition.problem, DirectSolvers());
    const Eigen::MatrixXd plus = inverseMatrix(decomposition.problem, inverse);
    EXPECT_LE((plus - plus.transpose()).norm(), 1e-12 * plus.norm());
  }
}

TEST(GeneralizedInverseTest, GivesAllCopiesOfACrosspointTheSameValue) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    const DecomposedProblem& problem = decomposition.problem;
    GeneralizedInverse inverse(problem, DirectSolvers());
    SubdomainVectors u;
    inverse.apply(forcesOf(problem, randomVector(decomposition::mergedSize(problem), 7)), u);
    const SubdomainVectors mean = valuesOf(problem, mergeValues(problem, u));
    for (std::size_t s = 0; s < u.size(); ++s)
      EXPECT_LE((u[s] - mean[s]).lpNorm<Eigen::Infinity>(), 1e-14 * u[s].lpNorm<Eigen::Infinity>());
  }
}

TEST(GeneralizedInverseTest, ForcesAndConstraintsAreTransposed) {
  const auto decomposition = decompose(twoMembranes(false, 5, metis(3)), world());
  const DecomposedProblem& problem = decomposition.problem;
  const GeneralizedInverse inverse(problem, DirectSolvers());
  const DenseProblem dense = densify(problem);
  const Eigen::VectorXd lambda = randomVector(dense.constraint.rows(), 1);
  const Eigen::VectorXd u = randomVector(dense.constraint.cols(), 2);

  const auto rows = localIndices(*problem.multiplierGhostMap);
  std::vector<double> mine(rows.size()), jump(rows.size(), -1.0);
  for (std::size_t i = 0; i < mine.size(); ++i)
    mine[i] = lambda[rows[static_cast<decltype(rows.size())>(i)]];
  SubdomainVectors forces = valuesOf(problem, Eigen::VectorXd::Zero(u.size()));
  inverse.subtractForces(mine, forces); // −B̄ᵀλ
  const SubdomainVectors values = valuesOf(problem, u);
  inverse.constraint(values, jump); // this rank's part of B̄u

  Eigen::Vector2d work = Eigen::Vector2d::Zero();
  for (std::size_t s = 0; s < values.size(); ++s)
    work[0] -= forces[s].col(0).dot(values[s].col(0));
  for (std::size_t i = 0; i < mine.size(); ++i)
    work[1] += mine[i] * jump[i];
  EXPECT_NEAR(work[0], work[1], 1e-13 * lambda.norm() * u.norm());
}

/// Text of the error that set-up with a wrong kernel ends in; the same on all ranks.
std::string complaint(const DecomposedProblem& problem) {
  try {
    const GeneralizedInverse inverse(problem, DirectSolvers());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(GeneralizedInverseTest, RefusesAKernelThatIsNone) {
  for (const double scale : {1e-9, 1.0, 1e9}) { // whatever the unit of stiffness
    SCOPED_TRACE(scale);
    auto decomposition = decompose(twoMembranes(false, 4, grid(2, 2)), world());
    for (auto& subdomain : decomposition.problem.subdomains) {
      decomposition::changeStiffness(subdomain, [&](decomposition::SparseMatrix& k) {
        k *= scale;
        if (subdomain.number == 4) // of the floating body: a spring that nobody declared
          k.coeffRef(0, 0) *= 1.001;
      });
    }
    EXPECT_NE(complaint(decomposition.problem).find("rigid modes"), std::string::npos)
        << complaint(decomposition.problem);
  }
}

TEST(GeneralizedInverseTest, AcceptsAnyUnitOfStiffnessAndOneSubdomainABody) {
  for (const double scale : {1e-9, 1.0, 1e9})
    for (const auto& cut : {grid(1, 1), grid(2, 2)}) {
      auto decomposition = decompose(twoMembranes(false, 4, cut), world());
      for (auto& subdomain : decomposition.problem.subdomains)
        decomposition::changeStiffness(subdomain, [&](decomposition::SparseMatrix& k) { k *= scale; });
      EXPECT_EQ(complaint(decomposition.problem), "");
    }
}

TEST(GeneralizedInverseTest, AcceptsBodiesOfVeryDifferentStiffness) {
  for (const double jump : {1e-8, 1e8}) {
    scene::Scene scene = twoMembranes(false, 4, grid(2, 2));
    scene.bodies[1].material.conductivity = jump;
    const auto decomposition = decompose(scene, world());
    ASSERT_EQ(complaint(decomposition.problem), "");
    GeneralizedInverse inverse(decomposition.problem, DirectSolvers());
    const Eigen::MatrixXd k = densify(decomposition.problem).stiffness;
    // K̄ K̄⁺ K̄ = K̄ body by body, each measured by its own stiffness.
    const Eigen::VectorXd size = k.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd difference = k * inverseMatrix(decomposition.problem, inverse) * k - k;
    EXPECT_LE((size.asDiagonal() * difference * size.asDiagonal()).norm(),
              1e-11 * static_cast<double>(k.rows()));
  }
}

TEST(GeneralizedInverseTest, CountsTheBytesOfItsFactors) {
  const auto decomposition = decompose(twoMembranes(true, 6, grid(2, 2)), world());
  const GeneralizedInverse inverse(decomposition.problem, DirectSolvers());
  EXPECT_EQ(inverse.coarseProblem().size(),
            static_cast<int>(decomposition.problem.crosspointMap->getGlobalNumElements()));
  EXPECT_GT(inverse.factorBytes(), 0u);
}

TEST(GeneralizedInverseTest, UnknownDirectSolversAreRefusedOnAllRanks) {
  const auto decomposition = decompose(twoMembranes(true, 4, grid(1, 1)), world()); // some ranks have nothing
  EXPECT_THROW(GeneralizedInverse(decomposition.problem, DirectSolvers{"KLU3", "KLU2"}), InputError);
  EXPECT_THROW(GeneralizedInverse(decomposition.problem, DirectSolvers{"KLU2", "KLU3"}), InputError);
}

} // namespace
} // namespace epafi::fetidp
