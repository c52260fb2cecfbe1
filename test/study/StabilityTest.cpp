/// The hard cases of `epafi-study stability` that are small, each with its expected outcome.

#include "StabilityCase.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

struct Family {
  const char* name;
  StabilityCases (*cases)(bool quick);
};

class StabilityTest : public testing::TestWithParam<Family> {};

/// On all ranks, or on as many as the case asks for.
void expectAsExpected(const StabilityCase& trial) {
  const RCP<const Comm> all = Tpetra::getDefaultComm();
  if (trial.ranks > all->getSize())
    return;
  RCP<const Comm> comm = all;
  if (trial.ranks > 0)
    comm = all->split(all->getRank() < trial.ranks ? 0 : -1, all->getRank());
  if (comm.is_null())
    return;
  const CaseResult result = runCase(trial, comm);
  if (!trial.remains.empty()) {
    EXPECT_FALSE(isAsExpected(trial.expected, result))
        << trial.name << ", " << trial.parameter << ", " << trial.variant << " is mended: take its mark away";
    return;
  }
  EXPECT_TRUE(isAsExpected(trial.expected, result))
      << trial.name << ", " << trial.parameter << ", " << trial.variant << ": expected "
      << toString(trial.expected) << ", found " << toString(result.outcome) << " (" << result.status << ": "
      << result.reason << ")";
}

/// One rank tries all; several ranks try what may depend on them, fewer families the more there are.
bool isTried(const StabilityCase& trial, int ranks) {
  const auto isOneOf = [&](std::initializer_list<const char*> families) {
    return std::find(families.begin(), families.end(), trial.family) != families.end();
  };
  if (ranks == 1)
    return true;
  if (trial.variant == "plain")
    return false;
  return ranks == 2   ? !isOneOf({"choices", "incompressible"})
         : ranks <= 4 ? isOneOf({"ranks", "input", "known failures", "floating"})
                      : isOneOf({"ranks", "input"});
}

TEST_P(StabilityTest, EndsAsExpected) {
  for (const StabilityCase& trial : GetParam().cases(true))
    if (isTried(trial, Tpetra::getDefaultComm()->getSize()))
      expectAsExpected(trial);
}

INSTANTIATE_TEST_SUITE_P(Families, StabilityTest,
                         testing::Values(Family{"jumps", jumpCases}, Family{"shapes", shapeCases},
                                         Family{"floating", floatingCases}, Family{"contact", contactCases},
                                         Family{"incompressible", incompressibleCases},
                                         Family{"units", unitCases}, Family{"choices", choiceCases},
                                         Family{"ranks", rankCases},
                                         Family{"knownFailures", knownFailureCases},
                                         Family{"programs", programCases}, Family{"input", inputCases}),
                         [](const auto& family) { return std::string(family.param.name); });

TEST(StabilityCaseTest, NoTwoCasesAreTheSame) {
  std::set<std::string> names;
  for (const StabilityCase& trial : allStabilityCases(false))
    EXPECT_TRUE(
        names.insert(trial.family + ": " + trial.name + ", " + trial.parameter + ", " + trial.variant).second)
        << trial.family << ": " << trial.name << ", " << trial.parameter << ", " << trial.variant;
  EXPECT_GT(names.size(), 300U);
}

CaseResult thrown(const std::function<void()>& work) {
  StabilityCase trial;
  trial.run = [&](const RCP<const Comm>&) {
    work();
    return CaseResult();
  };
  return runCase(trial, Tpetra::getDefaultComm());
}

TEST(StabilityCaseTest, WhatIsThrownIsAnOutcome) {
  const auto impossible = [] { throw SolvabilityError(SolvabilityError::Kind::noSolution, "pulled off"); };
  const auto loose = [] { throw SolvabilityError(SolvabilityError::Kind::notUnique, "loose"); };
  EXPECT_EQ(thrown(impossible).outcome, Outcome::noSolution);
  EXPECT_EQ(thrown(loose).outcome, Outcome::notUnique);
  EXPECT_EQ(thrown([] { throw InputError("NaN"); }).outcome, Outcome::wrongInput);
  EXPECT_EQ(thrown([] { throw Error("no memory"); }).outcome, Outcome::failed);
  EXPECT_EQ(thrown([] { throw std::bad_alloc(); }).outcome, Outcome::failed);
  EXPECT_EQ(thrown(impossible).reason, "pulled off");
}

TEST(StabilityCaseTest, AnOutcomeOtherThanExpectedIsNoticed) {
  CaseResult result;
  result.outcome = Outcome::noSolution;
  result.reason = "the load pulls 'right' off";
  EXPECT_TRUE(isAsExpected(noSolution("pulls"), result));
  EXPECT_FALSE(isAsExpected(noSolution("tips"), result));
  EXPECT_FALSE(isAsExpected(notUnique("pulls"), result));
  EXPECT_FALSE(isAsExpected(solved(), result));
  EXPECT_FALSE(isAsExpected(solvedOrStopped(), result));
  for (const Outcome wrong : {Outcome::wrongAnswer, Outcome::failed}) {
    result.outcome = wrong;
    for (const Expectation& expectation :
         {solved(), noSolution(""), wrongInput(""), stopped(""), solvedOrStopped()})
      EXPECT_FALSE(isAsExpected(expectation, result)) << toString(expectation);
  }
}

} // namespace
} // namespace epafi::drivers
