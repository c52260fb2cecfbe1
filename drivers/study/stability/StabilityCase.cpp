#include "StabilityCase.hpp"

#include "CaseTable.hpp"
#include "ContactRun.hpp"
#include "ProgramRun.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>
#include <array>

namespace epafi::drivers {
namespace {

constexpr std::array<const char*, 7> outcomes{"solved",
                                              "refused: no solution",
                                              "refused: not unique",
                                              "refused: wrong input",
                                              "stopped",
                                              "wrong answer",
                                              "failed"};

Outcome outcomeOf(const std::string& words) {
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (words == outcomes[i] || "refused: " + words == outcomes[i])
      return static_cast<Outcome>(i);
  throw InputError('"' + words + "\" is no outcome of a case");
}

StabilityCase trialOf(Case&& one) {
  StabilityCase trial{one.family, one.name, one.parameter};
  trial.expected = Expectation(one.list.get("Expected", "solved"));
  trial.value = one.value;
  trial.variant = one.list.get("Variant", trial.variant);
  trial.ranks = static_cast<int>(one.list.get("Ranks", 0.0));
  trial.run = [one = std::move(one)](const RCP<const Comm>& comm) {
    return one.list.isSublist("Program") ? runProgram(one.list, comm) : runContact(one, comm);
  };
  return trial;
}

} // namespace

std::string toString(Outcome outcome) {
  return outcomes.at(static_cast<std::size_t>(outcome));
}

Expectation::Expectation(const std::string& words) {
  const std::string ends = words.substr(0, words.find(": "));
  if (ends.size() < words.size())
    keyword = words.substr(ends.size() + 2);
  const auto next = ends.find(" or ");
  outcomes.push_back(outcomeOf(ends.substr(0, next)));
  if (next != std::string::npos)
    outcomes.push_back(outcomeOf(ends.substr(next + 4)));
}

std::string toString(const Expectation& expectation) {
  std::string text;
  for (const Outcome outcome : expectation.outcomes)
    text.append(text.empty() ? "" : " or ").append(toString(outcome));
  return expectation.keyword.empty() ? text : text + " (" + expectation.keyword + ")";
}

void CaseResult::judge(const std::string& complaint) {
  if (outcome != Outcome::solved || complaint.empty())
    return;
  outcome = Outcome::wrongAnswer;
  reason = complaint;
}

std::vector<StabilityCase> stabilityCases(const std::string& family, bool quick) {
  std::vector<StabilityCase> trials;
  for (Case& one : expandCases(caseText("stability"), family, quick))
    trials.push_back(trialOf(std::move(one)));
  return trials;
}

CaseResult runCase(const StabilityCase& trial, const RCP<const Comm>& comm) {
  const double start = Teuchos::Time::wallTime();
  CaseResult result;
  const auto refuse = [&](Outcome outcome, const std::exception& error) {
    result = CaseResult();
    result.outcome = outcome;
    result.reason = error.what();
  };
  try {
    result = trial.run(comm);
  } catch (const SolvabilityError& error) {
    refuse(error.kind() == SolvabilityError::Kind::noSolution ? Outcome::noSolution : Outcome::notUnique,
           error);
  } catch (const InputError& error) {
    refuse(Outcome::wrongInput, error);
  } catch (const std::exception& error) {
    refuse(Outcome::failed, error);
  }
  result.seconds = maxOverRanks(*comm, Teuchos::Time::wallTime() - start);
  return result;
}

bool isAsExpected(const Expectation& expectation, const CaseResult& result) {
  const auto& ends = expectation.outcomes;
  return std::find(ends.begin(), ends.end(), result.outcome) != ends.end() &&
         (result.status + ": " + result.reason).find(expectation.keyword) != std::string::npos;
}

} // namespace epafi::drivers
