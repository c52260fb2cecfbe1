/// The hard cases of `epafi-study stability` that are small, each with its expected outcome.

#include "CaseTable.hpp"
#include "ProgramRun.hpp"
#include "StabilityCase.hpp"

#include "epafi/base/Errors.hpp"

#include <Eigen/Dense>
#include <Teuchos_Array.hpp>
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

class StabilityTest : public testing::TestWithParam<const char*> {};

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
  for (const StabilityCase& trial : stabilityCases(GetParam(), true))
    if (isTried(trial, Tpetra::getDefaultComm()->getSize()))
      expectAsExpected(trial);
}

INSTANTIATE_TEST_SUITE_P(Families, StabilityTest,
                         testing::Values("jumps", "shapes", "floating", "contact", "incompressible",
                                         "meshes that do not match", "units", "choices", "ranks",
                                         "known failures", "quadratic programs", "input", "friction"),
                         [](const auto& family) {
                           std::string name = family.param;
                           std::erase(name, ' ');
                           return name;
                         });

TEST(StabilityCaseTest, NoTwoCasesAreTheSame) {
  std::set<std::string> names;
  for (const StabilityCase& trial : stabilityCases("", false))
    EXPECT_TRUE(
        names.insert(trial.family + ": " + trial.name + ", " + trial.parameter + ", " + trial.variant).second)
        << trial.family << ": " << trial.name << ", " << trial.parameter << ", " << trial.variant;
  EXPECT_EQ(names.size(), 987U);
}

/// Whether one step of primal–dual active sets after the other, from this set of three, never ends.
bool alternatesFrom(int set, const benchmarks::DenseProgram& program) {
  for (int step = 0; step < 16; ++step) {
    Eigen::MatrixXd a = program.hessian;
    Eigen::VectorXd b = program.linear;
    for (int i = 0; i < 3; ++i)
      if ((set >> i & 1) != 0) {
        a.row(i) = Eigen::VectorXd::Unit(3, i).transpose();
        b[i] = 0;
      }
    const Eigen::VectorXd x = a.partialPivLu().solve(b), force = program.linear - program.hessian * x;
    int next = 0;
    for (int i = 0; i < 3; ++i)
      next |= ((set >> i & 1) != 0 ? force[i] >= 0 : x[i] > 0) ? 1 << i : 0;
    if (next == set)
      return false;
    set = next;
  }
  return true;
}

TEST(StabilityCaseTest, ActiveSetsDoAlternateWhereACaseSaysSo) {
  for (const Case& one : expandCases(caseText("stability"), "quadratic programs", true))
    if (one.name == "active sets that alternate for ever") {
      const benchmarks::DenseProgram program = programOf(one.list.sublist("Program"));
      bool some = false;
      for (int start = 0; start < 8; ++start)
        some = some || alternatesFrom(start, program);
      EXPECT_TRUE(some);
      return;
    }
  FAIL() << "there is no such case";
}

TEST(CaseTableTest, ExpandsLoopsScenesAndConditions) {
  const char* text = "scene base n=2\n"
                     "  Bodies/a/Elements = {$n, 2*$n}\n"
                     "  Bodies/b/Conductivity = 1\n"
                     "family first\n"
                     "  let m = 3 | 4\n"
                     "  for k,word in 1,one; 2,two, or so; 3,\n"
                     "    case $word of $k; $k parts; 10^$k/1e+1\n"
                     "      use base n=($m+$k)\n"
                     "      if $k > 1\n"
                     "        Bodies/*/Conductivity = -1e-2*$k\n"
                     "      remove Bodies/b\n"
                     "family second\n"
                     "  for i from 0 to 2 step 2\n"
                     "    case $i\n";

  const std::vector<Case> cases = expandCases(text, "first", true);

  ASSERT_EQ(cases.size(), 3);
  EXPECT_EQ(cases[1].name, "two, or so of 2");
  EXPECT_EQ(cases[1].parameter, "2 parts");
  EXPECT_EQ(cases[1].value, 10);
  const Teuchos::ParameterList& a = cases[1].list.sublist("Bodies").sublist("a");
  EXPECT_EQ(a.get<Teuchos::Array<int>>("Elements")[1], 10);
  EXPECT_EQ(a.get<double>("Conductivity"), -0.02);
  EXPECT_FALSE(cases[0].list.sublist("Bodies").sublist("a").isParameter("Conductivity"));
  EXPECT_FALSE(cases[0].list.sublist("Bodies").isSublist("b"));
  EXPECT_EQ(expandCases(text, "first", false)[0].list.sublist("Bodies").sublist("a").get<Teuchos::Array<int>>(
                "Elements")[0],
            5);
  EXPECT_EQ(expandCases(text, "", true).size(), 5) << "all families";
}

TEST(CaseTableTest, NamesTheLineThatIsWrong) {
  for (const char* wrong : {"use nothing", "A = $b", "A = 1+", "nonsense"})
    try {
      expandCases(std::string("family f\n  case c\n    ") + wrong + '\n', "", true);
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("line 3"), std::string::npos) << error.what();
    }
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
  EXPECT_TRUE(isAsExpected(Expectation("no solution: pulls"), result));
  EXPECT_FALSE(isAsExpected(Expectation("no solution: tips"), result));
  EXPECT_FALSE(isAsExpected(Expectation("not unique: pulls"), result));
  EXPECT_FALSE(isAsExpected(Expectation("solved"), result));
  EXPECT_FALSE(isAsExpected(Expectation("solved or stopped"), result));
  for (const Outcome wrong : {Outcome::wrongAnswer, Outcome::failed}) {
    result.outcome = wrong;
    for (const char* words : {"solved", "no solution", "wrong input", "stopped", "solved or stopped"})
      EXPECT_FALSE(isAsExpected(Expectation(words), result)) << words;
  }
}

} // namespace
} // namespace epafi::drivers
