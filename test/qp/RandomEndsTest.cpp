#include "QpProblems.hpp"
#include "RandomPrograms.hpp"

#include <gtest/gtest.h>

#include <string>

/// Random programs without a solution, every one from its seed alone: named, and with a certificate that
/// holds for the dense data.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

constexpr unsigned numEnds = 200;

unsigned strideOfEnds() {
  return Tpetra::getDefaultComm()->getSize() == 1 ? 1 : 20;
}

TEST(RandomEndsTest, InfeasibleProgramsAreNamedWithACertificate) {
  for (unsigned seed = 0; seed < numEnds; seed += strideOfEnds()) {
    const RandomProgram random = randomInfeasibleProgram(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.kind);

    const QpAnswer answer = solveQp(random.program);

    EXPECT_EQ(answer.report.status, Status::infeasible) << answer.report.reason;
    EXPECT_FALSE(answer.report.reason.empty());
    EXPECT_TRUE(answer.x.allFinite());
    const bool isBoxEmpty = (random.program.lower.array() > random.program.upper.array()).any();
    EXPECT_EQ(answer.certificate.size(), isBoxEmpty ? 0 : random.program.numRows());
    if (answer.certificate.size() > 0) {
      EXPECT_NEAR(answer.certificate.norm(), 1, 1e-12);
      EXPECT_GT(separation(random.program, answer.certificate), 0);
    }
  }
}

TEST(RandomEndsTest, UnboundedProgramsAreNamedWithADirection) {
  for (unsigned seed = 0; seed < numEnds; seed += strideOfEnds()) {
    const RandomProgram random = randomUnboundedProgram(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.kind);

    const QpAnswer answer = solveQp(random.program);

    EXPECT_EQ(answer.report.status, Status::unbounded)
        << toString(answer.report.status) << ": " << answer.report.reason;
    EXPECT_TRUE(answer.x.allFinite());
    if (answer.report.status == Status::unbounded) {
      EXPECT_EQ(whyNotRecession(random.program, answer.certificate), "");
    }
  }
}

} // namespace
