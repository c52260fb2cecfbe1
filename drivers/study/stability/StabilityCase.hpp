#pragma once

/// A hard case: what is tried, what is expected of it, and how it is tried. And what came of it.

#include "epafi/base/Types.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace epafi::drivers {

/// How a run may end. `solved` is what a check that knows nothing of the solver's bookkeeping has confirmed; an answer
/// that is claimed but not confirmed is `wrongAnswer`, the worst of all.
enum class Outcome { solved, noSolution, notUnique, wrongInput, stopped, wrongAnswer, failed };

/// What is expected, written before the run: one of these ends, the reason of which contains `keyword`.
struct Expectation {
  std::vector<Outcome> outcomes;
  std::string keyword = {};
};

inline Expectation solved() {
  return {{Outcome::solved}};
}
inline Expectation noSolution(const std::string& keyword) {
  return {{Outcome::noSolution}, keyword};
}
inline Expectation notUnique(const std::string& keyword) {
  return {{Outcome::notUnique}, keyword};
}
inline Expectation wrongInput(const std::string& keyword) {
  return {{Outcome::wrongInput}, keyword};
}
/// It ends without the answer, and says so.
inline Expectation stopped(const std::string& keyword) {
  return {{Outcome::stopped}, keyword};
}
/// Where arithmetic or a method without a preconditioner promises no answer: none is claimed that is not one.
inline Expectation solvedOrStopped() {
  return {{Outcome::solved, Outcome::stopped}};
}

/// "solved", "refused: no solution", …
std::string toString(Outcome outcome);
/// "solved", "refused: no solution (pulls)", "solved or stopped", …
std::string toString(const Expectation& expectation);

/// NaN: not known, or without meaning here.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct CaseResult {
  Outcome outcome = Outcome::failed;
  std::string status; ///< of the solver; empty if it was not reached
  std::string reason; ///< in words: the solver's, the error's, or what the check found
  int products = 0;   ///< with F, or with the Hessian
  int normProducts = 0;
  double projectedGradient = unknown; ///< relative, recomputed
  // Recomputed without the solver; see UndecomposedSolution.hpp.
  double balance = unknown, penetration = unknown, complementarity = unknown;
  double energyError = unknown; ///< ‖u − u*‖_K relative to ‖u*‖_K, u* by a direct solver
  double energy = unknown, force = unknown;
  long long active = -1;
  double seconds = 0;
};

struct StabilityCase {
  std::string family;    ///< one of the files in this folder
  std::string name;      ///< what is hard
  std::string parameter; ///< how hard, in words
  Expectation expected;
  std::function<CaseResult(const RCP<const Comm>&)> run; ///< collective
  double value = unknown;                                ///< how hard, as a number where there is one
  std::string variant = "default";                       ///< "plain": without preconditioner
  int ranks = 0;                                         ///< how many it takes; 0: as many as there are
  std::string remains = {}; ///< why it is known to end otherwise than expected; empty if it is not
};

using StabilityCases = std::vector<StabilityCase>;

/// Runs it; whatever is thrown becomes an outcome. Collective over `comm`, which has the ranks that the case takes.
CaseResult runCase(const StabilityCase& trial, const RCP<const Comm>& comm);

[[nodiscard]] bool isAsExpected(const Expectation& expectation, const CaseResult& result);

// The families. Quick ones are small enough for tests.
StabilityCases jumpCases(bool quick);
StabilityCases shapeCases(bool quick);
StabilityCases floatingCases(bool quick);
StabilityCases contactCases(bool quick);
StabilityCases incompressibleCases(bool quick);
StabilityCases unitCases(bool quick);
StabilityCases choiceCases(bool quick);
StabilityCases rankCases(bool quick);
StabilityCases knownFailureCases(bool quick); ///< where programs of this kind have failed their users
StabilityCases programCases(bool quick);      ///< the same for quadratic programs taken alone
StabilityCases inputCases(bool quick);        ///< degenerate and ill-posed input

/// All families, in this order.
StabilityCases allStabilityCases(bool quick);

} // namespace epafi::drivers
