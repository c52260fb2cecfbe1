#include "Preconditioned.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace epafi::fetidp {
namespace {

std::vector<ContactCase> allCases() {
  std::vector<ContactCase> cases = contactCases();
  const std::vector<ContactCase> hard = hardCases();
  cases.insert(cases.end(), hard.begin(), hard.end());
  return cases;
}

TEST(DualPreconditionerTest, IsSymmetricPositiveDefinite) {
  for (const ContactCase& c : allCases())
    for (const PreconditionerParameters& parameters : allPreconditioners(false)) {
      SCOPED_TRACE(c.name + "; " + describe(parameters));
      const Eigen::MatrixXd m = matrixOf(Preconditioned(c.scene, parameters).m);
      ASSERT_GT(m.diagonal().minCoeff(), 0);
      EXPECT_LE(scaledAsymmetry(m), 1e-11);
      EXPECT_GT(scaledSpectrum(m).minCoeff(), 1e-3);
      if (std::getenv("EPAFI_M")) std::cout << c.name << "; " << describe(parameters) << ": " << scaledAsymmetry(m) << " " << scaledSpectrum(m).minCoeff() << std::endl;
    }
}

TEST(DualPreconditionerTest, InSinglePrecisionItIsSymmetricPositiveDefiniteToSixDigits) {
  for (const ContactCase& c : allCases())
    for (const PreconditionerParameters& parameters : allPreconditioners(true)) {
      SCOPED_TRACE(c.name + "; " + describe(parameters));
      PreconditionerParameters full = parameters;
      full.isSingle = false;
      const Eigen::MatrixXd m = matrixOf(Preconditioned(c.scene, parameters).m);
      ASSERT_GT(m.diagonal().minCoeff(), 0);
      EXPECT_LE(scaledAsymmetry(m), 1e-6);
      EXPECT_GT(scaledSpectrum(m).minCoeff(), 1e-3);
      EXPECT_LE(relativeError(m, matrixOf(Preconditioned(c.scene, full).m)), 1e-6);
      if (std::getenv("EPAFI_M")) std::cout << c.name << "; " << describe(parameters) << ": " << scaledAsymmetry(m) << " " << scaledSpectrum(m).minCoeff() << " " << relativeError(m, matrixOf(Preconditioned(c.scene, full).m))<< std::endl;
    }
}

} // namespace
} // namespace epafi::fetidp
