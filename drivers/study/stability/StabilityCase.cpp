#include "StabilityCase.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>

namespace epafi::drivers {

std::string toString(Outcome outcome) {
  switch (outcome) {
  case Outcome::solved:
    return "solved";
  case Outcome::noSolution:
    return "refused: no solution";
  case Outcome::notUnique:
    return "refused: not unique";
  case Outcome::wrongInput:
    return "refused: wrong input";
  case Outcome::stopped:
    return "stopped";
  case Outcome::wrongAnswer:
    return "wrong answer";
  case Outcome::failed:
    return "failed";
  }
  return "unknown";
}

std::string toString(const Expectation& expectation) {
  std::string text;
  for (const Outcome outcome : expectation.outcomes)
    text.append(text.empty() ? "" : " or ").append(toString(outcome));
  return expectation.keyword.empty() ? text : text + " (" + expectation.keyword + ")";
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
  const auto& outcomes = expectation.outcomes;
  return std::find(outcomes.begin(), outcomes.end(), result.outcome) != outcomes.end() &&
         (result.status + ": " + result.reason).find(expectation.keyword) != std::string::npos;
}

StabilityCases allStabilityCases(bool quick) {
  StabilityCases all;
  for (const auto family : {jumpCases, shapeCases, floatingCases, contactCases, incompressibleCases,
                            unitCases, choiceCases, rankCases, knownFailureCases, programCases, inputCases})
    for (StabilityCase& trial : family(quick))
      all.push_back(std::move(trial));
  return all;
}

} // namespace epafi::drivers
