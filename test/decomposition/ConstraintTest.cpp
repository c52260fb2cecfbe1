#include "support/Gathered.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace epafi::decomposition {
namespace {

TEST(ConstraintTest, EveryGluingRowJoinsTwoCopiesOfOneNode) {
  for (const Case& c : smallCases()) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    const DecomposedProblem& p = result.problem;
    const std::size_t n = p.dualDimension();
    std::vector<double> plus(n, 0), minus(n, 0), other(n, 0), lower(n, 0), higher(n, 0), difference(n, 0);
    for (const Subdomain& s : p.subdomains)
      for (const ConstraintEntry& entry : s.constraint) {
        const std::size_t row = p.numberOf(entry.multiplier);
        plus[row] += entry.coefficient == 1 ? 1 : 0;
        minus[row] += entry.coefficient == -1 ? 1 : 0;
        other[row] += std::abs(entry.coefficient) != 1 ? 1 : 0;
        (entry.coefficient > 0 ? lower : higher)[row] += s.number;
        difference[row] += entry.coefficient * nodeKey(s, entry.unknown, p.components);
      }
    for (auto* values : {&plus, &minus, &other, &lower, &higher, &difference})
      sumOverRanks(*p.comm, *values);
    double previous = -1;
    for (std::size_t row = p.numInequalities; row < n; ++row) {
      EXPECT_EQ(plus[row], 1) << row;
      EXPECT_EQ(minus[row], 1) << row;
      EXPECT_EQ(difference[row], 0) << row;
      EXPECT_LT(lower[row], higher[row]) << row;
      EXPECT_LE(previous, lower[row]) << row; // numbered by the lower subdomain
      previous = lower[row];
    }
    EXPECT_EQ(std::count(other.begin(), other.end(), 0), static_cast<std::ptrdiff_t>(n));
  }
}

TEST(ConstraintTest, NoRowIsRedundant) {
  for (const Case& c : smallCases()) {
    const auto result = decompose(c.scene, world());
    const Eigen::MatrixXd b = mergedConstraint(result.problem);
    if (b.rows() == 0)
      continue;
    SCOPED_TRACE(c.name);
    EXPECT_EQ(kernelDimension(b * b.transpose()), 0);
  }
}

/// Energy minimum of a floating or held scene whose gluing is enforced by eliminating rows from the merged
/// problem.
TEST(ConstraintTest, GluedSubdomainsAreTheUndividedBody) {
  const std::vector<fem::SolidSupport> supports = {{"left", "left", {1.0}}};
  const auto whole = decompose(oneBody(6, 5, grid(1, 1), supports), world());
  const auto energyOf = [](const Decomposition& cut) {
    const DecomposedProblem& p = cut.problem;
    // Saddle point [K Bᵀ; B 0], dense; the load is found like the matrix, copy by copy.
    const Eigen::MatrixXd k = mergedStiffness(p), b = mergedConstraint(p);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(k.rows());
    Eigen::Index next = p.remainderMap->getMinGlobalIndex();
    const Eigen::Index numRemainders = p.remainderMap->getGlobalNumElements();
    double offset = 0;
    for (std::size_t place = 0; place < p.subdomains.size(); ++place) {
      const Subdomain& s = p.subdomains[place];
      const Eigen::VectorXd load = cut.data.subdomains()[place].rightHandSide();
      for (const int unknown : s.remainderUnknowns)
        f[next++] += load[unknown];
      for (std::size_t i = 0; i < s.crosspointUnknowns.size(); ++i)
        f[numRemainders + static_cast<Eigen::Index>(s.crosspointIndices[i])] += load[s.crosspointUnknowns[i]];
      offset += cut.data.subdomains()[place].energyOffset();
    }
    sumOverRanks(*p.comm, std::span(f.data(), static_cast<std::size_t>(f.size())));
    offset = sumOverRanks(*p.comm, offset);
    Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(k.rows() + b.rows(), k.rows() + b.rows());
    saddle.topLeftCorner(k.rows(), k.rows()) = k;
    saddle.bottomLeftCorner(b.rows(), k.rows()) = b;
    saddle.topRightCorner(k.rows(), b.rows()) = b.transpose();
    Eigen::VectorXd right = Eigen::VectorXd::Zero(saddle.rows());
    right.head(k.rows()) = f;
    const Eigen::VectorXd u = direct::leastSquares(saddle, right).col(0).head(k.rows());
    return 0.5 * u.dot(k * u) - f.dot(u) + offset;
  };
  const double expected = energyOf(whole);
  for (const auto& cut : {grid(2, 2), grid(3, 1), metis(4), metis(6)}) {
    const auto parts = decompose(oneBody(6, 5, cut, supports), world());
    EXPECT_NEAR(energyOf(parts), expected, 1e-12 * std::abs(expected));
  }
}

} // namespace
} // namespace epafi::decomposition
