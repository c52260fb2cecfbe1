#include "support/Preconditioned.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/operator/CondensedSubdomain.hpp"

#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

using decomposition::Subdomain;

/// One subdomain by both: sparse and condensed, and dense.
struct Compared {
  Compared(const Subdomain& subdomain, const std::string& solver)
      : factorizer(solver), condensed(subdomain, interfaceOf(subdomain), true, factorizer) {
    const Eigen::MatrixXd k(*subdomain.stiffness);
    const auto &r = subdomain.remainderUnknowns, &c = subdomain.crosspointUnknowns;
    krr = k(r, r);
    krc = k(r, c);
    kcc = k(c, c);
    inverse = direct::inverseOfSpd(krr);
  }

  direct::Factorizer factorizer;
  CondensedSubdomain condensed;
  Eigen::MatrixXd krr, krc, kcc, inverse; ///< inverse of K_rr
};

/// ‖a − b‖ relative to the size that b's terms have; b may vanish.
void expectNear(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double size) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  EXPECT_LE((a - b).norm(), 1e-12 * size);
}

template <class Check>
void forEachSubdomain(const Check& check) {
  for (const std::string& solver : direct::availableSolvers())
    for (const ContactCase& c : contactCases()) {
      const auto decomposition = decompose(c.scene, world());
      for (const Subdomain& subdomain : decomposition.problem.subdomains) {
        SCOPED_TRACE(solver + ", " + c.name + ", subdomain " + std::to_string(subdomain.number));
        check(Compared(subdomain, solver));
      }
    }
}

TEST(CondensedSubdomainTest, BothDirectSolversAreThere) {
  const std::vector<std::string> solvers = direct::availableSolvers();
  for (const char* name : {"KLU2", "CHOLMOD"})
    EXPECT_NE(std::find(solvers.begin(), solvers.end(), name), solvers.end()) << name;
}

TEST(CondensedSubdomainTest, CouplesCrosspointsAsDenseEliminationDoes) {
  forEachSubdomain([](const Compared& s) {
    const Eigen::MatrixXd psi = s.inverse * s.krc;
    expectNear(s.condensed.crosspointResponse(), psi, 1 + psi.norm());
    expectNear(s.condensed.boundaryResponse(), psi(s.condensed.interface().boundary, allOf), 1 + psi.norm());
    expectNear(s.condensed.schurComplement(), s.kcc - s.krc.transpose() * psi, s.kcc.norm());
    EXPECT_EQ(s.condensed.schurComplement(), s.condensed.schurComplement().transpose());
    expectNear(Eigen::MatrixXd(s.condensed.remainderToCrosspoint()), s.krc, 0);
  });
}

TEST(CondensedSubdomainTest, CondensesTheBoundaryAsDenseEliminationDoes) {
  forEachSubdomain([](const Compared& s) {
    const std::vector<int>& boundary = s.condensed.interface().boundary;
    const Eigen::MatrixXd flexibility = s.inverse(boundary, boundary);
    const Eigen::MatrixXd inverse = s.condensed.factor().inverseOfKept(),
                          schur = s.condensed.factor().schurComplement();
    expectNear(inverse, flexibility, flexibility.norm());
    EXPECT_EQ(inverse, inverse.transpose());
    // S_ΔΔ by eliminating I.
    std::vector<int> inner;
    for (int i = 0; i < static_cast<int>(s.krr.rows()); ++i)
      if (std::find(boundary.begin(), boundary.end(), i) == boundary.end())
        inner.push_back(i);
    Eigen::MatrixXd expected = s.krr(boundary, boundary);
    if (!inner.empty() && !boundary.empty()) {
      const Eigen::MatrixXd inside = s.krr(inner, inner), coupling = s.krr(inner, boundary);
      expected -= coupling.transpose() * direct::solvedSymmetric(inside, coupling);
    }
    expectNear(schur, expected, expected.norm());
    EXPECT_EQ(schur, schur.transpose());
  });
}

TEST(CondensedSubdomainTest, KnowsItsSizes) {
  forEachSubdomain([](const Compared& s) {
    EXPECT_EQ(s.condensed.numRemainders(), s.krr.rows());
    EXPECT_EQ(s.condensed.numCrosspoints(), s.kcc.rows());
    EXPECT_EQ(s.condensed.numBoundary(), static_cast<Eigen::Index>(s.condensed.interface().boundary.size()));
  });
}

/// Where a whole subdomain can move, S lets it: S R_c = 0.
TEST(CondensedSubdomainTest, ASubdomainThatIsFreeToMoveFeelsNoForceWhenAllItsCrosspointsMoveAlike) {
  for (const std::string& solver : direct::availableSolvers()) {
    const auto decomposition = decompose(twoMembranes(false, 4, grid(2, 2)), world());
    for (const Subdomain& subdomain : decomposition.problem.subdomains) {
      if (subdomain.body == 0)
        continue; // held by its wall
      const Compared s(subdomain, solver);
      ASSERT_GT(s.condensed.numCrosspoints(), 1);
      const Eigen::VectorXd ones = Eigen::VectorXd::Ones(s.condensed.numCrosspoints());
      EXPECT_LE((s.condensed.schurComplement() * ones).norm(), 1e-14 * s.kcc.norm());
      EXPECT_LE((s.condensed.boundaryResponse() * ones).array().abs().maxCoeff() - 1, 1e-13); // Ψ 1 = −1
    }
  }
}

} // namespace
} // namespace epafi::fetidp
